# compile_together(TARGET ["FOLDER FOLDER ..."]... | ALL)
# The sources of a folder are compiled as one piece: what their headers bring along is parsed and instantiated once for all of them. Folders
# named together (relative to the room) share a piece, with ALL a whole target. Names in anonymous namespaces of one piece must therefore
# differ; a folder that cannot help it joins another piece. Sources with compile options of their own stay alone.
# A build for editing, a source at a time: the presets debug and asan, or -DACTFORMER_TOGETHER=OFF.
option(ACTFORMER_TOGETHER "Compile the sources of a folder as one" ON)
set(MOST_TOGETHER 20)  # sources of a folder that is named nowhere

function(compile_together target)
  if(NOT ACTFORMER_TOGETHER)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(ABSOLUTE_PATH folder)
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
    set(piece "")
    foreach(folders ${ARGN})
      string(REPLACE " " ";" named "${folders}")
      if(folder IN_LIST named OR folders STREQUAL ALL)
        string(MAKE_C_IDENTIFIER "${folders}" piece)
      endif()
    endforeach()
    if(NOT piece)
      string(MAKE_C_IDENTIFIER "in_${folder}" folder)
      if(NOT DEFINED ${folder})
        set(${folder} 0)
      endif()
      math(EXPR part "${${folder}} / ${MOST_TOGETHER}")
      math(EXPR ${folder} "${${folder}} + 1")
      set(piece ${folder}_${part})
    endif()
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${piece})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # Names shadow those of another source; what a source hides no longer looks hidden.
  target_compile_options(${target} PRIVATE -Wno-shadow $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()
