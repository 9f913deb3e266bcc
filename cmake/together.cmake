# The sources of a folder are compiled as one: what their headers bring along is parsed and instantiated once for all of them. Names in anonymous
# namespaces of one folder must therefore differ. Sources with compile options of their own stay alone.
# A build for editing, a source at a time: the presets debug and asan, or -DACTFORMER_TOGETHER=OFF.
option(ACTFORMER_TOGETHER "Compile the sources of a folder as one" ON)
set(MOST_TOGETHER 12)  # sources: two cores have several such pieces each to the end

function(compile_together target)
  if(NOT ACTFORMER_TOGETHER)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(ABSOLUTE_PATH folder)
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${CMAKE_SOURCE_DIR})
    string(MAKE_C_IDENTIFIER "in_${folder}" folder)
    if(NOT DEFINED ${folder})
      set(${folder} 0)
    endif()
    math(EXPR piece "${${folder}} / ${MOST_TOGETHER}")
    math(EXPR ${folder} "${${folder}} + 1")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder}_${piece})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # Names shadow those of another source; what a source hides no longer looks hidden.
  target_compile_options(${target} PRIVATE -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()
