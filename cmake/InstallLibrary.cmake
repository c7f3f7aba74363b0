# Builds and installs libsundog, shared and static, for other programs: the layers up to host/api, the headers
# in include/sundog, and the files for find_package(sundog) and pkg-config.
include(CMakePackageConfigHelpers)

add_library(sundog_shared SHARED $<TARGET_OBJECTS:sundog_api>)
target_link_libraries(sundog_shared PRIVATE sundog_render)
# Templates of other libraries stay visible despite the compiler's options, so the linker exports only the
# public names.
set(symbols ${PROJECT_SOURCE_DIR}/host/api/symbols.map)
# If two plug-ins each bring a copy into a process, each copy must call its own functions. Once loaded, the
# library stays loaded, because threads of drivers and oneTBB still run its code at a dlclose().
target_link_options(sundog_shared PRIVATE -Wl,--version-script=${symbols} -Wl,--no-undefined -Wl,-Bsymbolic-functions -Wl,-z,nodelete)
set_target_properties(sundog_shared PROPERTIES LINK_DEPENDS ${symbols} VERSION ${PROJECT_VERSION}
  SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})

# All layers in one archive; a program that links it also links their dependencies.
set(objects "")
foreach(layer base base_cold formula models scene scene_cold compile lanes device render api)
  list(APPEND objects $<TARGET_OBJECTS:sundog_${layer}>)
endforeach()
add_library(sundog_static STATIC ${objects})
set(packages OpenCL TBB fmt OpenEXR ZLIB Threads)
set(libraries spng deflate turbojpeg webp)
target_link_libraries(sundog_static INTERFACE OpenCL::OpenCL TBB::tbb fmt::fmt OpenEXR::OpenEXR ZLIB::ZLIB Threads::Threads
  ${libraries} ${CMAKE_DL_LIBS})

set(exported sundog)  # sundog::sundog and sundog::sundog_static
foreach(library sundog_shared sundog_static)
  target_include_directories(${library} INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${library} INTERFACE cxx_std_20)
  add_library(sundog::${exported} ALIAS ${library})  # for add_subdirectory() and FetchContent; find_package() gives the same name
  set_target_properties(${library} PROPERTIES OUTPUT_NAME sundog EXPORT_NAME ${exported} LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}
    ARCHIVE_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
  set(exported sundog_static)
endforeach()

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/sundog)
# Two components: `library` for running programs, `development` for building them.
install(TARGETS sundog_shared sundog_static EXPORT sundogTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/sundog DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(EXPORT sundogTargets NAMESPACE sundog:: DESTINATION ${package_folder} COMPONENT development)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/sundogConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/sundogConfig.cmake
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/sundogConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/sundogConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/sundogConfigVersion.cmake
  DESTINATION ${package_folder} COMPONENT development)

list(TRANSFORM libraries PREPEND -l OUTPUT_VARIABLE private_libraries)
list(JOIN private_libraries " " private_libraries)
# The prefix may be moved, so paths are relative to the file's own folder.
file(RELATIVE_PATH pc_to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" pc_to_prefix "${pc_to_prefix}")
# Two files, because a Requires.private would demand the other libraries' development packages for the shared
# library too.
foreach(name sundog sundog-static)
  configure_file(${PROJECT_SOURCE_DIR}/cmake/${name}.pc.in ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
endforeach()
