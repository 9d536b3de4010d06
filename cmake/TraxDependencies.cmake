# What the build needs from Debian; setup.sh installs it.

find_package(LLVM 19.1 REQUIRED CONFIG HINTS /usr/lib/llvm-19)
find_package(Clang REQUIRED CONFIG HINTS /usr/lib/llvm-19)
set(LLVM_TABLEGEN_EXE ${LLVM_TOOLS_BINARY_DIR}/llvm-tblgen)

find_package(PkgConfig REQUIRED)
pkg_check_modules(LIBELF REQUIRED IMPORTED_TARGET libelf)
pkg_check_modules(LIBDW REQUIRED IMPORTED_TARGET libdw)
pkg_check_modules(LIBCONFIG REQUIRED IMPORTED_TARGET libconfig)
pkg_check_modules(JANSSON REQUIRED IMPORTED_TARGET jansson)
pkg_check_modules(ASSIMP REQUIRED IMPORTED_TARGET assimp)
pkg_check_modules(LZMA REQUIRED IMPORTED_TARGET liblzma)
find_package(PNG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(embree 3 REQUIRED)
find_package(Threads REQUIRED)
find_library(CMOCKA_LIBRARY cmocka REQUIRED)
