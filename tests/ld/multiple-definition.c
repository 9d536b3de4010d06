/* Two definitions of a symbol are an error that names both places; --allow-multiple-definition takes the first.

   RUN: rm -rf %t && mkdir %t && cd %t
   RUN: %clang -O1 -DVALUE=1 -DMAIN -c %s -o a.o && %clang -O1 -DVALUE=2 -c %s -o b.o
   RUN: not %clang a.o b.o -o no 2>&1 | FileCheck %s && not ls no
   CHECK: trax-ld: error: b.o:(.text.value+0x0): duplicate symbol 'value', first defined at a.o:(.text.value+0x0)
   RUN: %clang a.o b.o -o first -Wl,--allow-multiple-definition && %python -c "import subprocess, sys; sys.exit(subprocess.call(['%trax_bin/trax-sim', 'first']) != 1)"
   RUN: %clang b.o a.o -o second -Wl,--allow-multiple-definition && %python -c "import subprocess, sys; sys.exit(subprocess.call(['%trax_bin/trax-sim', 'second']) != 2)"
*/
int value(void) { return VALUE; }
#ifdef MAIN
int value(void);
int main(void) {
  int (*volatile get)(void) = value;
  return get();
}
#endif
