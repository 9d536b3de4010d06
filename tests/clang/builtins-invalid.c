// RUN: %clang -fsyntax-only -Xclang -verify %s

void wrong(unsigned n, unsigned *p, float *f) {
  __builtin_trax_rdsr(n);     // expected-error {{argument to '__builtin_trax_rdsr' must be a constant integer}}
  __builtin_trax_trap(1, n);  // expected-error {{argument to '__builtin_trax_trap' must be a constant integer}}
  __builtin_trax_trap(1);     // expected-error {{too few arguments to function call, expected 2, have 1}}
  __builtin_trax_halt(1);     // expected-error {{too many arguments to function call, expected 0, have 1}}
  __builtin_trax_rsqrt(p);    // expected-error {{passing 'unsigned int *' to parameter of incompatible type 'float'}}
  __builtin_trax_box(1, 2);   // expected-error {{too few arguments to function call, expected 13, have 2}}
  __builtin_trax_triangle(1); // expected-error {{too few arguments to function call, expected 16, have 1}}
  __builtin_trax_ainc(f);     // expected-warning {{incompatible pointer types passing 'float *' to parameter of type 'unsigned int *'}}
}
