# What `cmake --install` puts where. The tree may be moved as a whole: the program finds what belongs to it by where it lies.
#
#   bin/actformer                       libexec/actformer/actformer-render, actformer-train and its .so
#   share/actformer/model/configs       share/actformer/reports/sweeps, share/actformer/{weights,examples}/cmu
#   share/man/man1                      share/doc/actformer
#   share/{bash-completion/completions,zsh/site-functions,fish/vendor_completions.d}
include(GNUInstallDirs)

# What comes with the program lies beside it where it was built, too.
foreach(folder model/configs reports/sweeps weights/cmu examples/cmu)
  cmake_path(GET folder PARENT_PATH room)
  file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/share/actformer/${room})
  file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${folder} ${CMAKE_BINARY_DIR}/share/actformer/${folder} SYMBOLIC)
  install(DIRECTORY ${folder}/ DESTINATION share/actformer/${folder} COMPONENT program)
endforeach()

install(TARGETS actformer DESTINATION bin COMPONENT program)
if(TARGET actformer-render)
  install(TARGETS actformer-render DESTINATION libexec/actformer COMPONENT program)
endif()
if(TARGET actformer-train)
  install(TARGETS actformer-train actformer-train.so DESTINATION libexec/actformer COMPONENT training)
endif()

install(FILES README.md CHANGELOG.md CITATION.cff LICENSE DESTINATION share/doc/actformer COMPONENT docs)
install(DIRECTORY docs python DESTINATION share/doc/actformer COMPONENT docs PATTERN __pycache__ EXCLUDE)
# What the README links to.
install(FILES examples/cmu/README.md DESTINATION share/doc/actformer/examples/cmu COMPONENT docs)
install(FILES weights/cmu/README.md weights/cmu/motions.gif DESTINATION share/doc/actformer/weights/cmu COMPONENT docs)

# Each package has the licence, the weights' own too.
foreach(component program=actformer training=actformer-train docs=actformer-doc)
  string(REPLACE "=" ";" component ${component})
  list(POP_FRONT component name)
  install(FILES LICENSE DESTINATION share/doc/${component} RENAME copyright COMPONENT ${name})
endforeach()

# Man pages and completions, which the program itself writes.
install(CODE "
  set(program \"${CMAKE_BINARY_DIR}/actformer\")
  set(share \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/share\")
  execute_process(COMMAND \${program} man -o \${share}/man/man1 OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  foreach(shell bash=bash-completion/completions/actformer zsh=zsh/site-functions/_actformer fish=fish/vendor_completions.d/actformer.fish)
    string(REPLACE \"=\" \";\" shell \${shell})
    list(POP_FRONT shell name)
    get_filename_component(folder \${share}/\${shell} DIRECTORY)
    file(MAKE_DIRECTORY \${folder})
    execute_process(COMMAND \${program} completion \${name} OUTPUT_FILE \${share}/\${shell} COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
" COMPONENT program)

include(cmake/packages.cmake)
