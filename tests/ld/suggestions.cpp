/* Suggestions for an undefined symbol.

   RUN: rm -rf %t && mkdir %t && cd %t
   RUN: %clang -x c -DDEFINES -c %s -o defines.o && %clang -x c -DLIBRARY -c %s -o library.o && llvm-ar rc lib.a library.o
   RUN: %clangxx -O1 -DNEEDS -c %s -o needs.o && %clangxx -DOTHER -c %s -o other.o
   RUN: not %trax_ld needs.o other.o defines.o lib.a -e main -o no 2>&1 | FileCheck %s --implicit-check-not=error: --implicit-check-not=">>>"
   CHECK: error: {{.*}}: undefined symbol 'c_function(int)' (in function 'main')
   CHECK-NEXT: >>> did you mean to declare 'c_function' as extern "C"? 'c_function' is defined
   CHECK: error: {{.*}}: undefined symbol 'cpp_function'
   CHECK-NEXT: >>> did you mean to define 'cpp_function' as extern "C"? 'cpp_function(int)' is defined
   CHECK: error: {{.*}}: undefined symbol 'transposde'
   CHECK-NEXT: >>> did you mean 'transposed'?
   CHECK: error: {{.*}}: undefined symbol 'insrted'
   CHECK-NEXT: >>> did you mean 'inserted'?
   CHECK: error: {{.*}}: undefined symbol 'deleteed'
   CHECK-NEXT: >>> did you mean 'deleted'?
   CHECK: error: {{.*}}: undefined symbol 'CaseMatters'
   CHECK-NEXT: >>> did you mean 'casematters'?
   CHECK: error: {{.*}}: undefined symbol 'in_librarz'
   CHECK-NEXT: >>> did you mean 'in_library'?
   CHECK: error: {{.*}}: undefined symbol 'hidden'
   CHECK-NEXT: >>> defines.o has a 'hidden', but it is local (static)
   CHECK: error: {{.*}}: undefined symbol 'nowhere'
*/
#ifdef NEEDS
int c_function(int);
extern "C" int cpp_function(int), transposde(int), insrted(int), deleteed(int), CaseMatters(int), in_librarz(int), hidden(int),
    nowhere(int);
int main() {
  return c_function(1) + cpp_function(1) + transposde(1) + insrted(1) + deleteed(1) + CaseMatters(1) + in_librarz(1) + hidden(1) +
         nowhere(1);
}
#elif defined(OTHER)
int cpp_function(int x) { return x; }
#elif defined(LIBRARY)
int in_library(int x) { return x; }
#else
__attribute__((used)) static int hidden(int x) { return x; }
int c_function(int x) { return x; }
int transposed(int x) { return x; }
int inserted(int x) { return x; }
int deleted(int x) { return x; }
int casematters(int x) { return x; }
#endif
