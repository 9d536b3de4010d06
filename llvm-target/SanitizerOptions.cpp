//===- SanitizerOptions.cpp - AddressSanitizer beside Debian's libLLVM ---===//
//
// Part of every program over LLVM in sanitizer builds. LLVM's headers are instrumented and poison memory that an
// allocator has not given out; the same functions in Debian's library are not, and give it out still poisoned. Leaks
// are not reported, because a compiler frees nothing before it exits.
//
//===----------------------------------------------------------------------===//
extern "C" const char *__asan_default_options();
const char *__asan_default_options() {
  return "allow_user_poisoning=0:detect_leaks=0";
}
