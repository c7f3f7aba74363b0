# Lists every struct of kernels/shared and its members, read from the headers themselves, as lines
#   SUNDOG_STRUCT(Ray)
#   SUNDOG_MEMBER(Ray, ox)
# which a test includes on the host and hands to every device, to compare sizes and offsets.
function(sundog_shared_layout output)
  file(GLOB headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/kernels/shared/*.h)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${headers})
  set(lines "")
  foreach(header IN LISTS headers)
    file(READ ${header} text)
    string(REGEX REPLACE "//[^\n]*" "" text "${text}")
    string(REGEX REPLACE "\\[[^]]*\\]" "" text "${text}")  # array sizes
    string(REPLACE ";" "," text "${text}")                # a semicolon would split a CMake list
    string(REGEX MATCHALL "typedef struct [A-Za-z0-9_]+ {[^}]*}" structs "${text}")
    foreach(struct IN LISTS structs)
      string(REGEX REPLACE "typedef struct ([A-Za-z0-9_]+).*" "\\1" name "${struct}")
      string(REGEX REPLACE ".*{(.*)}" "\\1" body "${struct}")
      string(APPEND lines "SUNDOG_STRUCT(${name})\n")
      string(REGEX MATCHALL "[A-Za-z_][A-Za-z0-9_]* *," members "${body}")  # a comma follows a member but not its type
      foreach(member IN LISTS members)
        string(REGEX REPLACE " *," "" member "${member}")
        string(APPEND lines "SUNDOG_MEMBER(${name}, ${member})\n")
      endforeach()
    endforeach()
  endforeach()
  file(CONFIGURE OUTPUT ${output} CONTENT "${lines}" @ONLY)
endfunction()
