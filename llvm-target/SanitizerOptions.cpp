//===- SanitizerOptions.cpp - AddressSanitizer beside Debian's libLLVM ---===//
//
// Part of every program over LLVM in sanitizer builds. LLVM's headers, which are instrumented, poison what an allocator
// has not given out yet; the library's copies of the same functions, which are not, give it out without a word. And a
// compiler that is about to exit frees nothing.
//
//===----------------------------------------------------------------------===//
extern "C" const char *__asan_default_options();
const char *__asan_default_options() {
  return "allow_user_poisoning=0:detect_leaks=0";
}
