# Writes a C++ file that holds each kernel file, by its path below this folder, as a string literal.
# cmake -DOUTPUT=out.cpp "-DFILES=frame/image.h;frame/prepare.cl" -P embed.cmake
set(text "#include \"opencl/kernel_sources.hpp\"\n\nnamespace dermis {\n\nconst std::map<std::string, std::string>& kernel_sources() {\n")
string(APPEND text "  static const std::map<std::string, std::string> sources = {\n")
foreach(file IN LISTS FILES)
  file(READ ${CMAKE_CURRENT_LIST_DIR}/${file} source)
  string(APPEND text "      {\"${file}\", R\"kernel(${source})kernel\"},\n")
endforeach()
string(APPEND text "  };\n  return sources;\n}\n\n}  // namespace dermis\n")
file(WRITE ${OUTPUT} "${text}")
