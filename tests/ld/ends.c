/* The ends of a program's parts, as other linkers name them.
   RUN: %clang -O1 %s -o %t && %trax_sim %t
   RUN: %clang -O1 -DOWN %s -o %t && %trax_sim %t && llvm-nm %t | FileCheck %s
   CHECK-NOT: etext */
extern char end[], _end[], etext[], _etext[], edata[], _edata[], __bss_start[], __text_end[];

int initialised = 1, zero;

#ifdef OWN
int end_of_program = 7;
int main(void) { return end_of_program != 7; }
#else
int main(void) {
  return end != _end || etext != _etext || edata != _edata || etext != __text_end || edata != __bss_start || (char *)&initialised >= edata ||
         (char *)&zero < edata || (char *)&zero >= end || (char *)(void *)main >= etext;
}
#endif
