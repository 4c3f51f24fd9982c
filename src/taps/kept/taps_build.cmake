# Writes a C++ file with a hash of files and of a text.
# cmake -DOUTPUT=out.cpp "-DFILES=a.cpp;b.hpp" "-DTEXT=..." -P taps_build.cmake
set(all "${TEXT}")
foreach(file IN LISTS FILES)
  file(SHA256 ${file} hash)
  string(APPEND all " ${hash}")
endforeach()
string(SHA256 hash "${all}")
file(WRITE ${OUTPUT} "#include \"taps/kept/taps_build.hpp\"\n\nconst char* const dermis::taps_build = \"${hash}\";\n")
