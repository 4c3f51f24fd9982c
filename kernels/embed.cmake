# Writes a C++ file that holds each kernel file as a string literal.
# cmake -DOUTPUT=out.cpp "-DFILES=a.cl;b.h" -P embed.cmake
set(text "#include \"core/kernel_sources.hpp\"\n\nnamespace dermis {\n\nconst std::map<std::string, std::string>& kernel_sources() {\n")
string(APPEND text "  static const std::map<std::string, std::string> sources = {\n")
foreach(file IN LISTS FILES)
  get_filename_component(name ${file} NAME)
  file(READ ${file} source)
  string(APPEND text "      {\"${name}\", R\"kernel(${source})kernel\"},\n")
endforeach()
string(APPEND text "  };\n  return sources;\n}\n\n}  // namespace dermis\n")
file(WRITE ${OUTPUT} "${text}")
