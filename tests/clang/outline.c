// -Oz outlines, -moutline does at any level of optimization, -mno-outline nowhere; the last one counts.
// RUN: %clang -Oz -S %s -o - | FileCheck %s --check-prefix=OUTLINED
// RUN: %clang -O2 -moutline -S %s -o - | FileCheck %s --check-prefix=OUTLINED
// RUN: %clang -O2 -mno-outline -moutline -S %s -o - | FileCheck %s --check-prefix=OUTLINED
// RUN: %clang -O2 -S %s -o - | FileCheck %s --check-prefix=WHOLE
// RUN: %clang -Oz -mno-outline -S %s -o - | FileCheck %s --check-prefix=WHOLE
// RUN: %clang -Oz -moutline -mno-outline -S %s -o - | FileCheck %s --check-prefix=WHOLE
// OUTLINED: OUTLINED_FUNCTION_0:
// WHOLE-NOT: OUTLINED_FUNCTION
int f(int a, int b, int c) { return ((a * 13 ^ b) * 31 + c) * (a ^ c); }
int g(int a, int b, int c) { return ((a * 13 ^ b) * 31 + c) * (a ^ c) + 5; }
int h(int a, int b, int c) { return ((a * 13 ^ b) * 31 + c) * (a ^ c) - 7; }
