/* A function that leaves by a tail call has no frame any more when the callee takes its own: the larger one of middle's
   and last's frames counts, not the sum. The program runs on no more than that.

   RUN: %clang -O2 -DMIDDLE=50 -DLAST=60 %s -o %t -Wl,--print-stack | FileCheck %s --check-prefix=SMALL
   SMALL:      stack: at most {{[0-9]+}} bytes, of 512 (local memory)
   SMALL:      {{^ *[0-9]+ +}}[[#FRAME:]] main,
   SMALL-NEXT: {{^}} 200 [[#FRAME+200]] middle, {{.*}}, leaves by a tail call
   SMALL-NEXT: {{^}} 240 [[#FRAME+240]] last, {{.*}}.text.last){{$}}
   SMALL-EMPTY:

   RUN: %clang -O2 -DMIDDLE=60 -DLAST=50 %s -o %t.large -Wl,--print-stack | FileCheck %s --check-prefix=LARGE
   LARGE:      stack: at most {{[0-9]+}} bytes, of 512 (local memory)
   LARGE:      {{^ *[0-9]+ +}}[[#FRAME:]] main,
   LARGE-NEXT: {{^}} 240 [[#FRAME+240]] middle, {{.*}}.text.middle){{$}}
   LARGE-EMPTY:

   RUN: %clang -O2 -DMIDDLE=50 -DLAST=60 %s -o %t.256 -Wl,-z,stack-size=256 && %trax_sim %t.256
   RUN: %trax_sim %t.large
*/
__attribute__((noinline)) int last(int n) {
  volatile int a[LAST];
  a[n] = n;
  return a[n] + 300;
}
__attribute__((noinline)) int middle(int n) {
  volatile int a[MIDDLE];
  a[n] = n;
  return last(a[n] + 1);
}
int main(void) {
  return middle(20) != 321;
}
