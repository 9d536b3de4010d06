// RUN: %run_c %s %t
// Every integer conversion with its flags.
#include <inttypes.h>
#include <stdio.h>

int main(void) {
  printf("[%d] [%i] [%u] [%x] [%X] [%o] [%c] [%%]\n", -1, 42, 3000000000u, 0xBEEF, 0xBEEF, 8, 'q');
  printf("[%5d] [%-5d] [%05d] [%+d] [% d] [%+5d] [%-+5d|]\n", 42, 42, 42, 42, 42, 42, 42);
  printf("[%.3d] [%8.3d] [%-8.3d] [%08.3d] [%.0d] [%#x] [%#o] [%#X]\n", 7, 7, 7, 7, 0, 255, 8, 255);
  printf("[%*d] [%-*d] [%.*d]\n", 6, 1, 6, 2, 3, 4);
  printf("[%hhd] [%hd] [%hhu] [%hu]\n", 300, 70000, 300, 70000);
  printf("[%lld] [%llu] [%llx] [%llo]\n", -9223372036854775807ll - 1, 18446744073709551615ull, 0x123456789ABCDEFull,
         0777777777777ull);
  printf("[%jd] [%zu] [%" PRIu64 "] [%" PRId32 "]\n", (intmax_t)-5, sizeof(int), UINT64_C(12345678901), INT32_C(-7));
  printf("[%s] [%10s] [%-10s] [%.2s] [%5.1s]\n", "text", "right", "left", "cut", "one");
  int count = printf("count\n");
  printf("%d\n", count);
  return 0;
}
