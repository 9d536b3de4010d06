# What the build needs from Debian; setup.sh installs it.

find_package(LLVM 19.1 REQUIRED CONFIG HINTS /usr/lib/llvm-19)
# Clang's own CMake package would define a target `clang`, the name of ours; its library is all that is needed.
find_library(CLANG_CPP_LIBRARY REQUIRED NAMES clang-cpp libclang-cpp.so.${LLVM_VERSION_MAJOR}.${LLVM_VERSION_MINOR}
  HINTS ${LLVM_LIBRARY_DIR} NO_DEFAULT_PATH)
find_path(CLANG_INCLUDE_DIR REQUIRED NAMES clang/Driver/Driver.h HINTS ${LLVM_INCLUDE_DIRS} NO_DEFAULT_PATH)
message(STATUS "LLVM ${LLVM_PACKAGE_VERSION}: ${LLVM_DIR}; clang: ${CLANG_CPP_LIBRARY} (docs/llvm-releases.md)")
set(LLVM_TABLEGEN_EXE ${LLVM_TOOLS_BINARY_DIR}/llvm-tblgen)

find_package(PkgConfig REQUIRED)
pkg_check_modules(LIBELF REQUIRED IMPORTED_TARGET libelf)
pkg_check_modules(LIBDW REQUIRED IMPORTED_TARGET libdw)
pkg_check_modules(LIBCONFIG REQUIRED IMPORTED_TARGET libconfig)
pkg_check_modules(JANSSON REQUIRED IMPORTED_TARGET jansson)
pkg_check_modules(XXHASH REQUIRED IMPORTED_TARGET libxxhash)
pkg_check_modules(GMP REQUIRED IMPORTED_TARGET gmp)
pkg_check_modules(LZMA REQUIRED IMPORTED_TARGET liblzma)
find_library(TINYEXR_LIBRARY tinyexr REQUIRED)
find_package(PNG REQUIRED)
find_library(PNG_STATIC_LIBRARY libpng16.a REQUIRED)
find_package(JPEG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3 REQUIRED)
endif()
find_path(EMBREE_INCLUDE_DIR rtcore.h PATH_SUFFIXES embree${embree_VERSION_MAJOR} REQUIRED NO_CACHE)
add_library(trax_embree INTERFACE) # <rtcore.h> of either
target_include_directories(trax_embree SYSTEM INTERFACE ${EMBREE_INCLUDE_DIR})
target_link_libraries(trax_embree INTERFACE ${EMBREE_LIBRARIES})
find_package(Threads REQUIRED)
