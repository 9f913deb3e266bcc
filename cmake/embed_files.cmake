# embed_files(OUT_VARIABLE "FILES" HEADER h NAMESPACE n FUNCTION f [NAMES g] KEY NAME|NAME_WE)
# Files made part of the program at build (see embed.cmake); OUT_VARIABLE is the C++ file to compile.
function(embed_files out files)
  cmake_parse_arguments(EMBED "" "HEADER;NAMESPACE;FUNCTION;NAMES;KEY" "" ${ARGN})
  set(made ${CMAKE_CURRENT_BINARY_DIR}/embedded_${EMBED_FUNCTION}.cpp)
  add_custom_command(
    OUTPUT ${made}
    COMMAND ${CMAKE_COMMAND} -DOUT=${made} "-DIN=${files}" -DHEADER=${EMBED_HEADER} -DNAMESPACE=${EMBED_NAMESPACE}
            -DFUNCTION=${EMBED_FUNCTION} -DNAMES=${EMBED_NAMES} -DKEY=${EMBED_KEY} -P ${CMAKE_SOURCE_DIR}/cmake/embed.cmake
    DEPENDS ${files} ${CMAKE_SOURCE_DIR}/cmake/embed.cmake
    COMMENT "Embedding files for ${EMBED_FUNCTION}()"
    VERBATIM)
  set(${out} ${made} PARENT_SCOPE)
endfunction()
