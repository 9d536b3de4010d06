# CMake toolchain for programs that run on the TP:
#
#   cmake -B build -DCMAKE_TOOLCHAIN_FILE=PREFIX/lib/trax/trax-toolchain.cmake
#
# The copy in PREFIX/lib/trax finds PREFIX/bin/trax-clang by itself; elsewhere say -DTRAX_PREFIX=PREFIX, PREFIX being where the
# toolchain was built or installed. Programs get the ending .elf.

set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR trax)

if(NOT TRAX_PREFIX)
  get_filename_component(TRAX_PREFIX "${CMAKE_CURRENT_LIST_DIR}/../.." ABSOLUTE)
endif()
set(TRAX_PREFIX "${TRAX_PREFIX}" CACHE PATH "Where the TRaX toolchain is")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES TRAX_PREFIX)
if(NOT EXISTS "${TRAX_PREFIX}/bin/trax-clang")
  message(FATAL_ERROR "there is no ${TRAX_PREFIX}/bin/trax-clang: set TRAX_PREFIX to where the TRaX toolchain is")
endif()

set(CMAKE_C_COMPILER "${TRAX_PREFIX}/bin/trax-clang")
set(CMAKE_C_COMPILER_TARGET trax)
set(CMAKE_CXX_COMPILER "${TRAX_PREFIX}/bin/trax-clang++")
set(CMAKE_CXX_COMPILER_TARGET trax)
set(CMAKE_ASM_COMPILER "${TRAX_PREFIX}/bin/trax-clang")
set(CMAKE_ASM_COMPILER_TARGET trax)
set(CMAKE_EXECUTABLE_SUFFIX_C .elf)
set(CMAKE_EXECUTABLE_SUFFIX_CXX .elf)
set(CMAKE_CROSSCOMPILING_EMULATOR "${TRAX_PREFIX}/bin/trax-sim")

# Code has fixed addresses whatever a project asks for. CMake sets these later, and then reads this file once more.
set(CMAKE_USER_MAKE_RULES_OVERRIDE "${CMAKE_CURRENT_LIST_FILE}")
foreach(language C CXX)
  set(CMAKE_${language}_COMPILE_OPTIONS_PIC "")
  set(CMAKE_${language}_COMPILE_OPTIONS_PIE "")
endforeach()

# find_package(trax) in the project.
set(trax_DIR "${TRAX_PREFIX}/lib/cmake/trax" CACHE PATH "Where traxConfig.cmake is")

# The host's libraries and headers are not the machine's.
set(CMAKE_FIND_ROOT_PATH "${TRAX_PREFIX}/lib/trax")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
