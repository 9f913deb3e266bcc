# add_program_apart(NAME SOURCE... [LEVELS LEVEL...]): a program whose libraries show their functions to nobody else. NAME itself only opens NAME.so, the
# target of all the rest. libtorch wants it: Debian's 2.6 exports functions of an LLVM of its own, and where they lie open an OpenCL
# driver takes them for those of its LLVM and crashes. With LEVELS there are builds of NAME.so for newer processors, x86-64-v3 say, beside
# it: NAME opens the best that the processor can run (program_apart.cpp).
function(add_program_apart name)
  add_executable(${name} ${CMAKE_SOURCE_DIR}/cmake/program_apart.cpp)
  cmake_parse_arguments(PARSE_ARGV 1 apart "" "" LEVELS)
  string(REPLACE ";" ":" levels "${apart_LEVELS}")
  target_compile_definitions(${name} PRIVATE ACTFORMER_LEAST="${ACTFORMER_LEVEL}" ACTFORMER_LEVELS="${levels}")
  if(CMAKE_SYSTEM_PROCESSOR STREQUAL x86_64)
    target_compile_options(${name} PRIVATE -march=x86-64)  # it says what a processor lacks
  endif()
  target_link_libraries(${name} PRIVATE ${CMAKE_DL_LIBS})
  add_library(${name}.so MODULE ${apart_UNPARSED_ARGUMENTS})
  set_target_properties(${name}.so PROPERTIES PREFIX "" OUTPUT_NAME ${name} SUFFIX .so
                        LIBRARY_OUTPUT_DIRECTORY $<TARGET_FILE_DIR:${name}>)
  target_link_options(${name}.so PRIVATE -Wl,-u,main)
  add_dependencies(${name} ${name}.so)
  foreach(level ${apart_LEVELS})
    build_for_level(${name} ${level})
  endforeach()
endfunction()

# NAME.so once more for a newer processor, by a build of its own, into a folder by the processor's name beside NAME.
function(build_for_level name level)
  include(ExternalProject)
  set(folder ${CMAKE_BINARY_DIR}/levels/${level})
  ExternalProject_Add(${name}-for-${level}
    SOURCE_DIR ${CMAKE_SOURCE_DIR} BINARY_DIR ${folder}
    CMAKE_CACHE_ARGS
      -DCMAKE_BUILD_TYPE:STRING=${CMAKE_BUILD_TYPE} -DCMAKE_CXX_COMPILER:STRING=${CMAKE_CXX_COMPILER}
      -DCMAKE_CXX_FLAGS:STRING=${CMAKE_CXX_FLAGS} -DCMAKE_MODULE_LINKER_FLAGS:STRING=-s
      -DCMAKE_PREFIX_PATH:STRING=${CMAKE_PREFIX_PATH} -DTorch_DIR:STRING=${Torch_DIR}
      -DCMAKE_COMPILE_WARNING_AS_ERROR:BOOL=${CMAKE_COMPILE_WARNING_AS_ERROR}
      -DACTFORMER_NATIVE:BOOL=OFF -DACTFORMER_LEVEL:STRING=${level} -DACTFORMER_TESTS:BOOL=OFF
    BUILD_COMMAND ${CMAKE_COMMAND} --build ${folder} --target ${name}.so
    INSTALL_COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_BINARY_DIR}/${level}
    COMMAND ${CMAKE_COMMAND} -E copy ${folder}/${name}.so ${CMAKE_BINARY_DIR}/${level}/
    BUILD_ALWAYS ON USES_TERMINAL_BUILD ON)
  add_dependencies(${name} ${name}-for-${level})
  install(PROGRAMS ${CMAKE_BINARY_DIR}/${level}/${name}.so DESTINATION libexec/actformer/${level} COMPONENT training)
endfunction()
