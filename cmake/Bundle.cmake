# Target `bundle`: sundog-VERSION-linux-x86_64.tar.zst, which runs from any folder and needs no packages.
# `bundle-slim`: the bundle without PoCL. Both have tinybvh_rays if SUNDOG_TINYBVH names its checkout.
foreach(kind IN ITEMS "" -slim)
  add_custom_target(bundle${kind} USES_TERMINAL VERBATIM DEPENDS sundog $<TARGET_NAME_IF_EXISTS:tinybvh_rays>
    COMMAND ${CMAKE_COMMAND} -E env BUNDLE_TINYBVH=${SUNDOG_TINYBVH}
            ${PROJECT_SOURCE_DIR}/cmake/make_bundle.sh $<TARGET_FILE:sundog>
            ${CMAKE_BINARY_DIR}/sundog-${PROJECT_VERSION}-linux-x86_64${kind}.tar.zst)
endforeach()
