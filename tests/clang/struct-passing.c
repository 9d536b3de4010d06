// Aggregates of up to four words travel in registers, each word with its own type (docs/abi.md, "Calls").
// RUN: %clang -O1 -S -emit-llvm %s -o - | FileCheck %s

typedef struct { float x, y, z; } vec3;
// CHECK-LABEL: define{{.*}} { float, float, float } @add(float %0, float %1, float %2, float %3, float %4, float %5)
// CHECK-NOT: alloca
// CHECK-COUNT-3: fadd float
// CHECK-NOT: alloca
// CHECK: ret { float, float, float }
vec3 add(vec3 a, vec3 b) { return (vec3){a.x + b.x, a.y + b.y, a.z + b.z}; }

typedef struct { float m[4]; } row;
// CHECK-LABEL: define{{.*}} { float, float, float, float } @array(float %0, float %1, float %2, float %3)
row array(row a) { return a; }

struct bytes { char r, g, b; };
// CHECK-LABEL: define{{.*}} i32 @bytes(i32 {{(returned )?}}%0)
struct bytes bytes(struct bytes a) { return a; }

struct mixed { char c; float f; short s, t; void *p; };
// CHECK-LABEL: define{{.*}} { i32, float, i32, ptr } @mixed(i32 %0, float %1, i32 %2, ptr %3)
struct mixed mixed(struct mixed a) { return a; }

union bits { float f; int i; };
// CHECK-LABEL: define{{.*}} i32 @bits(i32 {{(returned )?}}%0)
union bits bits(union bits a) { return a; }

union twice { float f; struct { float g; } h; };
// CHECK-LABEL: define{{.*}} float @twice(float {{(returned )?}}%0)
union twice twice(union twice a) { return a; }

struct wide { double d; long long l; };
// CHECK-LABEL: define{{.*}} { double, i64 } @wide(double %0, i64 %1)
struct wide wide(struct wide a) { return a; }

struct odd { float f; double d; }; // the double lies across even words
// CHECK-LABEL: define{{.*}} { float, double } @odd(float %0, double %1)
struct odd odd(struct odd a) { return a; }

union overlap { double d; struct { int i; float f; } s; };
// CHECK-LABEL: define{{.*}} { i32, i32 } @overlap(i32 %0, i32 %1)
union overlap overlap(union overlap a) { return a; }

struct __attribute__((packed)) packed { char c; float f; };
// CHECK-LABEL: define{{.*}} { i32, i32 } @packed(i32 %0, i32 %1)
struct packed packed(struct packed a) { return a; }

struct fields { unsigned a : 3, b : 20, c : 17; };
// CHECK-LABEL: define{{.*}} { i32, i32 } @fields(i32 %0, i32 %1)
struct fields fields(struct fields a) { return a; }

struct flexible { int n; float v[]; };
// CHECK-LABEL: define{{.*}} i32 @flexible(i32 {{(returned )?}}%0)
int flexible(struct flexible a) { return a.n; }

struct empty {};
// CHECK-LABEL: define{{.*}} void @empty(i32 noundef %0)
struct empty empty(struct empty a, int x) { return a; }

// CHECK-LABEL: define{{.*}} { float, float } @complex_float(float noundef %0, float noundef %1)
_Complex float complex_float(_Complex float a) { return a; }
// CHECK-LABEL: define{{.*}} { double, double } @complex_double(double noundef %0, double noundef %1)
_Complex double complex_double(_Complex double a) { return a; }

// A fifth word sends the whole through memory.
struct five { int v[5]; };
// CHECK-LABEL: define{{.*}} void @five(ptr {{.*}}sret(%struct.five) align 4 %0, ptr {{.*}}byval(%struct.five) align 4 %1)
struct five five(struct five a) { return a; }

// Stack slots are words; the callee makes its own aligned copy.
struct aligned { _Alignas(16) int v[5]; };
// CHECK-LABEL: define{{.*}} ptr @aligned(ptr {{.*}}byval(%struct.aligned) align 4 %0
// CHECK: alloca %struct.aligned, align 16
// CHECK: call void @llvm.memcpy
void *keep(void *);
void *aligned(struct aligned a) { return keep(&a); }
