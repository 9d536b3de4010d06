// C++: trivially copyable classes go in registers, all others by address.
// RUN: %clangxx -std=c++17 -O1 -S -emit-llvm %s -o - | FileCheck %s

struct base {
  float x;
};
struct derived : base {
  float y;
  int z;
};
// CHECK-LABEL: define{{.*}} { float, float, i32 } @_Z7inherit7derived(float %0, float %1, i32 %2)
derived inherit(derived a) {
  return a;
}

struct counted {
  int n;
  counted(const counted &);
};
// CHECK-LABEL: define{{.*}} void @_Z4copy7counted(ptr {{.*}}sret(%struct.counted) align 4 %0, ptr noundef{{[^,)]*}} %1)
counted copy(counted a) {
  return a;
}

struct polymorphic {
  virtual int get() const;
  int n;
};
// CHECK-LABEL: define{{.*}} i32 @_Z8virtual111polymorphic(ptr {{.*}}%0)
int virtual1(polymorphic a) {
  return a.n;
}

struct nothing {};
struct only_base : nothing {
  float f;
};
// CHECK-LABEL: define{{.*}} void @_Z5empty7nothing()
nothing empty(nothing a) {
  return a;
}
// CHECK-LABEL: define{{.*}} float @_Z9base_only9only_base(float {{(returned )?}}%0)
only_base base_only(only_base a) {
  return a;
}

template <typename T> struct vec { T x, y, z; };
// CHECK-LABEL: define{{.*}} { ptr, ptr, ptr } @_Z8pointers3vecIPfE(ptr %0, ptr %1, ptr %2)
vec<float *> pointers(vec<float *> a) {
  return a;
}

// Neither exceptions nor type information; but guards of local statics, which threads share.
// CHECK: call i32 @__cxa_guard_acquire
// CHECK-NOT: __cxa_{{[^g]}}
// CHECK-NOT: __gxx_personality
// CHECK-NOT: _ZTI
int may_throw();
int local_static() {
  static int value = may_throw();
  return value;
}
