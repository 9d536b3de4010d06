// RUN: %clangxx -std=c++20 -O2 -mstack=global %s -o %t && %trax_sim %t | FileCheck %s
// std::format of numbers, text and pointers.
#include <cstdio>
#include <format>
#include <string>

int main() {
  // CHECK: 1 -2 3000000000 0x1f 0b101 'x' true
  std::puts(std::format("{} {} {} {:#x} {:#b} '{}' {}", 1, -2, 3000000000u, 31, 5, 'x', true).c_str());
  // CHECK-NEXT: [   right] [left    ] [**mid***] [cut]
  std::puts(std::format("[{:>8}] [{:<8}] [{:*^8}] [{:.3}]", "right", std::string("left"), "mid", "cut short").c_str());
  // CHECK-NEXT: 0.1 0.1 1e+23 1.5 2.500 3.14e+00 00001.25 1.8p+1 inf -nan
  std::puts(std::format("{} {} {} {} {:.3f} {:.2e} {:08.2f} {:a} {} {}", 0.1, 0.1f, 1e23, 1.5L, 2.5, 3.14, 1.25, 3.0,
                        __builtin_inf(), -__builtin_nan(""))
                .c_str());
  // CHECK-NEXT: second first
  std::puts(std::format("{1} {0}", "first", "second").c_str());
  return 0;
}
