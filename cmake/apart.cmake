# add_program_apart(NAME SOURCE...): a program whose libraries show their functions to nobody else. NAME itself only opens NAME.so, the
# target of all the rest. libtorch wants it: Debian's 2.6 exports functions of an LLVM of its own, and where they lie open an OpenCL
# driver takes them for those of its LLVM and crashes.
function(add_program_apart name)
  add_executable(${name} ${CMAKE_SOURCE_DIR}/cmake/program_apart.cpp)
  target_compile_definitions(${name} PRIVATE ACTFORMER_LEAST="${ACTFORMER_LEVEL}")
  if(CMAKE_SYSTEM_PROCESSOR STREQUAL x86_64)
    target_compile_options(${name} PRIVATE -march=x86-64)  # it says what a processor lacks
  endif()
  target_link_libraries(${name} PRIVATE ${CMAKE_DL_LIBS})
  add_library(${name}.so MODULE ${ARGN})
  set_target_properties(${name}.so PROPERTIES PREFIX "" OUTPUT_NAME ${name} SUFFIX .so
                        LIBRARY_OUTPUT_DIRECTORY $<TARGET_FILE_DIR:${name}>)
  target_link_options(${name}.so PRIVATE -Wl,-u,main)
  add_dependencies(${name} ${name}.so)
  build_for_levels(${name})
endfunction()

# NAME.so once more for each of the newer processors that ACTFORMER_LEVELS names, each by a build of its own, into a folder by its name
# beside NAME, which opens the best that the processor can run (program_apart.cpp).
set(ACTFORMER_LEVELS "" CACHE STRING "Newer processors that programs have builds for as well, as in x86-64-v3;x86-64-v4")
function(build_for_levels name)
  include(ExternalProject)
  foreach(level ${ACTFORMER_LEVELS})
    set(folder ${CMAKE_BINARY_DIR}/levels/${level})
    if(NOT TARGET for-${level})
      ExternalProject_Add(for-${level}
        SOURCE_DIR ${CMAKE_SOURCE_DIR} BINARY_DIR ${folder}
        CMAKE_ARGS -DCMAKE_BUILD_TYPE=${CMAKE_BUILD_TYPE} -DCMAKE_COMPILE_WARNING_AS_ERROR=${CMAKE_COMPILE_WARNING_AS_ERROR}
                   -DACTFORMER_NATIVE=OFF -DACTFORMER_LEVEL=${level} -DACTFORMER_TESTS=OFF
        BUILD_COMMAND ${CMAKE_COMMAND} --build ${folder} --target ${name}.so
        INSTALL_COMMAND ${CMAKE_COMMAND} -E make_directory ${CMAKE_BINARY_DIR}/${level}
        COMMAND ${CMAKE_COMMAND} -E copy ${folder}/${name}.so ${CMAKE_BINARY_DIR}/${level}/
        BUILD_ALWAYS ON USES_TERMINAL_BUILD ON)
    endif()
    add_dependencies(${name} for-${level})
    install(PROGRAMS ${CMAKE_BINARY_DIR}/${level}/${name}.so DESTINATION libexec/actformer/${level} COMPONENT training)
  endforeach()
endfunction()
