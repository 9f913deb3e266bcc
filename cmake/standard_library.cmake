# Programs take the C++ standard library that all other libraries take. GCC outside a distribution may bring it as an archive alone; then
# a program has one of its own, and libtorch's and the OpenCL drivers' calls go partly to that and partly to the system's: std::call_once
# jumps to address 0. There programs are linked with the system's, and only what that lacks comes from the archive.
if(NOT DEFINED ACTFORMER_STANDARD_LIBRARY AND NOT CMAKE_CROSSCOMPILING)
  try_run(ran compiled SOURCES ${CMAKE_CURRENT_LIST_DIR}/linked_standard_library.cpp NO_CACHE LINK_LIBRARIES ${CMAKE_DL_LIBS}
          RUN_OUTPUT_VARIABLE system)
  if(compiled AND ran EQUAL 0)
    set(ACTFORMER_STANDARD_LIBRARY "${system}" CACHE INTERNAL "The system's libstdc++, where the compiler would link an archive")
  endif()
endif()
if(ACTFORMER_STANDARD_LIBRARY)
  message(STATUS "The compiler brings an archive of the C++ standard library: linking ${ACTFORMER_STANDARD_LIBRARY} before it")
  set(CMAKE_CXX_STANDARD_LIBRARIES "${ACTFORMER_STANDARD_LIBRARY} ${CMAKE_CXX_STANDARD_LIBRARIES}")
endif()
