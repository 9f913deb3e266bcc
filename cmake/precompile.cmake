# Parsing headers takes most of a build. Those that most sources of a target include are parsed once for all of them. Sources that are
# compiled with options of their own cannot share that. A build without it, which shows missing includes: -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON
set(STANDARD_HEADERS <algorithm> <filesystem> <functional> <map> <memory> <optional> <string> <vector> <fmt/format.h>)

function(precompile target)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    if(options)
      set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
    endif()
  endforeach()
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # It forgets which code lies in the system's headers, and warns of std::string's own insides (PR 105651).
    target_compile_options(${target} PRIVATE -Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds)
  endif()
  target_precompile_headers(${target} PRIVATE ${STANDARD_HEADERS} ${ARGN})
endfunction()
