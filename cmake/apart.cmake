# add_program_apart(NAME SOURCE...): a program whose libraries show their functions to nobody else. NAME itself only opens NAME.so, the
# target of all the rest. libtorch wants it: Debian's 2.6 exports functions of an LLVM of its own, and where they lie open an OpenCL
# driver takes them for those of its LLVM and crashes.
function(add_program_apart name)
  add_executable(${name} ${CMAKE_SOURCE_DIR}/cmake/program_apart.cpp)
  target_link_libraries(${name} PRIVATE ${CMAKE_DL_LIBS})
  add_library(${name}.so MODULE ${ARGN})
  set_target_properties(${name}.so PROPERTIES PREFIX "" OUTPUT_NAME ${name} SUFFIX .so
                        LIBRARY_OUTPUT_DIRECTORY $<TARGET_FILE_DIR:${name}>)
  target_link_options(${name}.so PRIVATE -Wl,-u,main)
  add_dependencies(${name} ${name}.so)
endfunction()
