# Debian packages by `cpack`: sundog (program, manual page, completions, scenes, pages), sundog-mpi,
# libsundog0.2 and libsundog-dev. tests/package.sh builds them and tests them on a bare system.
install(CODE "
  set(pages \"${CMAKE_CURRENT_BINARY_DIR}/command_pages\")
  execute_process(COMMAND \"${PROJECT_SOURCE_DIR}/cmake/write_command_pages.sh\" \"$<TARGET_FILE:sundog>\" \"\${pages}\"
    COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND gzip -9nf \"\${pages}/sundog.1\" COMMAND_ERROR_IS_FATAL ANY)
  file(INSTALL \"\${pages}/sundog.1.gz\" DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man1\")
  file(INSTALL \"\${pages}/sundog.bash\" RENAME sundog
    DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/bash-completion/completions\")
  file(INSTALL \"\${pages}/_sundog\" DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions\")
  file(INSTALL \"\${pages}/sundog.fish\" DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d\")
" COMPONENT program)

# Files that Debian requires in each package: copyright, a changelog in Debian's format, and overrides for
# lintian.
set(runtime lib${PROJECT_NAME}${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(changelog ${CMAKE_CURRENT_BINARY_DIR}/changelog)
set(maintainer "The sundog authors <sundog@localhost>")
file(WRITE ${changelog} "sundog (${PROJECT_VERSION}) unstable; urgency=medium

  * /usr/share/doc/sundog/CHANGELOG.md has what changes.

 -- ${maintainer}  Sun, 22 Nov 2026 12:00:00 +0000
")
execute_process(COMMAND gzip -9nf ${changelog})
set(packages program=sundog library=${runtime} development=lib${PROJECT_NAME}-dev)
if(TARGET sundog_mpi)
  list(APPEND packages mpi=sundog-mpi)
endif()
foreach(pair IN LISTS packages)
  string(REGEX REPLACE "=.*" "" component ${pair})
  string(REGEX REPLACE ".*=" "" package ${pair})
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/package/copyright ${changelog}.gz DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
    COMPONENT debian_${component} EXCLUDE_FROM_ALL)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/package/lintian-overrides DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides
    RENAME ${package} COMPONENT debian_${component} EXCLUDE_FROM_ALL)
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME sundog)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program documents debian_program library debian_library development debian_development)
if(TARGET sundog_mpi)
  list(APPEND CPACK_COMPONENTS_ALL mpi debian_mpi)
endif()
foreach(component PROGRAM DOCUMENTS DEBIAN_PROGRAM)
  set(CPACK_COMPONENT_${component}_GROUP sundog)
endforeach()
foreach(component LIBRARY DEVELOPMENT MPI)
  string(TOLOWER ${component} group)
  set(CPACK_COMPONENT_${component}_GROUP ${group})
  set(CPACK_COMPONENT_DEBIAN_${component}_GROUP ${group})
endforeach()
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${maintainer})
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_SUNDOG_PACKAGE_NAME sundog)
set(CPACK_DEBIAN_SUNDOG_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_SUNDOG_PACKAGE_RECOMMENDS "pocl-opencl-icd | opencl-icd")
set(CPACK_DEBIAN_SUNDOG_PACKAGE_SUGGESTS sundog-mpi)
set(CPACK_DEBIAN_SUNDOG_DESCRIPTION "renderer for meshes, solids and fractals, on OpenCL
Whitted's recursive ray tracing, or path tracing, with nested media and
absorption, on any OpenCL 1.2 device, a CPU through PoCL included.")
set(CPACK_DEBIAN_MPI_PACKAGE_NAME sundog-mpi)
set(CPACK_DEBIAN_MPI_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "sundog (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_MPI_DESCRIPTION "renderer on OpenCL - frames on many machines
What sundog loads when mpirun starts it.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME ${runtime})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS "pocl-opencl-icd | opencl-icd")
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "renderer on OpenCL - shared library
What programs that render with sundog need at run time.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME lib${PROJECT_NAME}-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${runtime} (= ${PROJECT_VERSION})")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "ocl-icd-opencl-dev, libtbb-dev, libfmt-dev, libopenexr-dev, libspng-dev, libdeflate-dev, \
libturbojpeg0-dev, libwebp-dev, zlib1g-dev")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "renderer on OpenCL - headers for C++ and C
Headers, the static library, the CMake package and the pkg-config file.")
include(CPack)
