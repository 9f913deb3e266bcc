# Writes OUT: a C++ file with the function that HEADER declares as
#   std::string_view NAMESPACE::FUNCTION(std::string_view name)
# and that gives the text of each file of the list IN by its name (KEY: NAME, or NAME_WE for names without their ending); with NAMES,
# the name of a second one, also
#   std::vector<std::string_view> NAMESPACE::NAMES()
set(text "// Made at build by cmake/embed.cmake.\n#include \"${HEADER}\"\n\nnamespace ${NAMESPACE} {\n\n")
string(APPEND text "std::string_view ${FUNCTION}(std::string_view name) {\n")
foreach(file IN LISTS IN)
  get_filename_component(name ${file} ${KEY})
  file(READ ${file} body)
  string(APPEND text "    if (name == \"${name}\") return R\"~text~(${body})~text~\";\n")
  string(APPEND names "\"${name}\", ")
endforeach()
string(APPEND text "    return {};\n}\n\n")
if(NAMES)
  string(APPEND text "std::vector<std::string_view> ${NAMES}() {\n    return {${names}};\n}\n\n")
endif()
string(APPEND text "}  // namespace ${NAMESPACE}\n")
file(WRITE ${OUT} "${text}")
