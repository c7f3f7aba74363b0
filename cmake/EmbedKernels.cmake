# Embeds every file of kernels/ into a library as {path, text} pairs; the host expands the includes.
# As a script (cmake -DKERNELS=folder -DOUTPUT=file -P) it writes the generated source; included, it adds the rule.

function(sundog_write_embedded_kernels folder output)
  file(GLOB_RECURSE files RELATIVE ${folder} ${folder}/*.h ${folder}/*.cl)
  list(SORT files)
  set(table "")
  set(count 0)
  foreach(file IN LISTS files)
    file(READ ${folder}/${file} text)
    string(APPEND table "    {\"${file}\",\n     R\"sundog(${text})sundog\"},\n")
    math(EXPR count "${count} + 1")
  endforeach()
  file(WRITE ${output} "// Generated from kernels/ by cmake/EmbedKernels.cmake.
#include \"device/embedded_kernels.h\"

namespace sundog {
namespace {
constexpr EmbeddedKernel files[] = {
${table}};
}  // namespace

std::span<const EmbeddedKernel> embedded_kernels() { return files; }
}  // namespace sundog
")
endfunction()

function(sundog_embed_kernels target)
  set(folder ${PROJECT_SOURCE_DIR}/kernels)
  set(output ${CMAKE_CURRENT_BINARY_DIR}/embedded_kernels.cpp)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${folder}/*.h ${folder}/*.cl)
  string(SHA1 list_hash "${files}")  # a file that was removed changes the command, and so runs it
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DKERNELS=${folder} -DOUTPUT=${output} -DLIST=${list_hash} -P ${PROJECT_SOURCE_DIR}/cmake/EmbedKernels.cmake
    DEPENDS ${files} ${PROJECT_SOURCE_DIR}/cmake/EmbedKernels.cmake
    COMMENT "Embedding the kernels" VERBATIM)
  target_sources(${target} PRIVATE ${output})
  set_source_files_properties(${output} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

if(CMAKE_SCRIPT_MODE_FILE)
  sundog_write_embedded_kernels(${KERNELS} ${OUTPUT})
endif()
