//===- SanitizerOptions.cpp - AddressSanitizer beside Debian's libLLVM ---===//
//
// Part of every program over LLVM in sanitizer builds. LLVM's headers are instrumented: their allocators poison memory
// that they have not handed out. The same functions in Debian's library are not instrumented and hand it out poisoned.
// Leaks are not reported, because a compiler frees nothing before it exits. Libraries have it, too: hence weak.
//
//===----------------------------------------------------------------------===//
extern "C" __attribute__((weak)) const char *__asan_default_options();
const char *__asan_default_options() {
  return "allow_user_poisoning=0:detect_leaks=0";
}
