# Language, warnings, sanitizers and where outputs go: the same for every part.

set(CMAKE_C_STANDARD 17)
set(CMAKE_C_STANDARD_REQUIRED ON)
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release or RelWithDebInfo" FORCE)
endif()
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
set(TRAX_TEST_BIN ${CMAKE_BINARY_DIR}/tests/bin) # programs that are not installed: tests, fuzzers, generators
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)
set(CMAKE_INSTALL_RPATH_USE_LINK_PATH ON) # Debian's LLVM
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/lib)

option(TRAX_TESTS "Tests, fuzzers and benchmarks" ON)
option(TRAX_UNITY "Files that include LLVM's headers are compiled several as one, which takes half of the time from nothing" ON)
option(TRAX_SANITIZE "Address and undefined-behaviour sanitizers" OFF)
option(TRAX_SANITIZE_THREADS "Thread sanitizer" OFF)
option(TRAX_COVERAGE "gcov's counters, also of programs that end by _exit (cmake --preset coverage)" OFF)
option(TRAX_FUZZ "libFuzzer's programs of llvm-target/fuzz: needs clang, implies TRAX_SANITIZE" OFF)
option(TRAX_WERROR "Warnings are errors" ON)

# What every target of ours links: warnings for our own code only, never for LLVM's headers. Host arithmetic must be
# IEEE 754: no contraction, no fast-math.
add_library(trax_flags INTERFACE)
target_compile_options(trax_flags INTERFACE -Wall -Wextra -ffp-contract=off $<$<BOOL:${TRAX_WERROR}>:-Werror>)
if(TRAX_FUZZ)
  if(NOT CMAKE_C_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "TRAX_FUZZ needs clang (cmake --preset fuzz) and Debian's libclang-rt-19-dev")
  endif()
  set(TRAX_SANITIZE ON)
endif()
if(TRAX_SANITIZE)
  target_compile_options(trax_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  # GCC takes a check that it inserted itself for a null pointer in clang's headers.
  target_compile_options(trax_flags INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-nonnull>)
  target_link_options(trax_flags INTERFACE -fsanitize=address,undefined)
endif()
if(TRAX_SANITIZE_THREADS)
  target_compile_options(trax_flags INTERFACE -fsanitize=thread -fno-omit-frame-pointer)
  target_link_options(trax_flags INTERFACE -fsanitize=thread)
endif()
if(TRAX_COVERAGE)
  add_library(trax-coverage STATIC tests/coverage_exit.c)
  target_link_libraries(trax_flags INTERFACE trax-coverage)
endif()
