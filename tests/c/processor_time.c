// DEFINE: %{mhz} =
// DEFINE: %{c} = %clang -O2 -DMHZ=%{mhz} %s -o %t
// DEFINE: %{cxx} = %clangxx -x c++ -std=c++20 -O2 -DMHZ=%{mhz} %s -o %t
// DEFINE: %{run} = %trax_sim %t --set chip.clock_mhz=%{mhz} | FileCheck %s
// RUN: %clang -O2 -DMHZ=500 %s -o %t && %trax_sim %t | FileCheck %s
// REDEFINE: %{mhz} = 1000
// RUN: %{c} && %{run}
// RUN: %{cxx} && %{run}
// REDEFINE: %{mhz} = 1
// RUN: %{c} && %{run}
// REDEFINE: %{mhz} = 100000
// RUN: %{c} && %{run}
// REDEFINE: %{mhz} = 333
// RUN: %{cxx} && %{run}
// Without a symbol table the loader cannot set the clock: clock fails as C says, and steady_clock stops.
// RUN: %clang -O2 -DMHZ=500 %s -o %t.stripped && llvm-strip %t.stripped && %trax_sim %t.stripped | FileCheck --check-prefix=STRIPPED %s
// RUN: %clangxx -x c++ -std=c++20 -O2 -DMHZ=500 %s -o %t.stripped && llvm-strip %t.stripped
// RUN: not %trax_sim %t.stripped 2>&1 | FileCheck --check-prefix=STOPPED %s
// clock, and C++'s clocks, go by the clock of the chip.
#include <stdio.h>
#include <time.h>
#include <trax.h>
#ifdef __cplusplus
#include <chrono>
#endif

static const clock_t second = CLOCKS_PER_SEC;

static double seconds_at(unsigned long long cycles) {
  return (double)cycles / (1e6 * MHZ);
}

int main(void) {
  unsigned long long before = trax_cycles64();
  clock_t now = clock();
  unsigned long long after = trax_cycles64();
  double seconds = (double)now / (double)second, unit = 1 / (double)second;
  // CHECK: the chip's time
  // STRIPPED: no time
  printf("%s\n", now == -1                                                                    ? "no time"
                 : seconds > seconds_at(before) - unit && seconds <= seconds_at(after) + unit ? "the chip's time"
                                                                                              : "another time");
  // CHECK-NEXT: the chip's time
  // STOPPED: message std::chrono::steady_clock: the loader did not say what the chip's clock is
  before = trax_cycles64();
#ifdef __cplusplus
  seconds = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
#else
  seconds = (double)clock() / CLOCKS_PER_SEC;
#endif
  after = trax_cycles64();
  printf("%s\n", seconds > seconds_at(before) - unit && seconds <= seconds_at(after) + unit ? "the chip's time"
                                                                                            : "another time");
  return 0;
}
