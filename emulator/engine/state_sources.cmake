# Writes a header with a hash of the sources that define what a checkpoint's state means:
#   cmake -D OUTPUT=FILE -D SOURCES=A,B,... -P state_sources.cmake
string(REPLACE "," ";" SOURCES "${SOURCES}")
set(hashes "")
foreach(source IN LISTS SOURCES)
  file(SHA256 ${source} hash)
  string(APPEND hashes ${hash})
endforeach()
string(SHA256 hash "${hashes}")
string(SUBSTRING ${hash} 0 16 hash)
file(WRITE ${OUTPUT} "#define TRAX_STATE_SOURCES 0x${hash}u\n")
