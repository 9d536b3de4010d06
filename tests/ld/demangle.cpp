// Names of C++ in messages and in the stack's report are as they are written; --no-demangle leaves them.
// RUN: not %clangxx %s -o %t 2>&1 | FileCheck %s
// RUN: not %clangxx %s -Wl,--no-demangle -o %t 2>&1 | FileCheck %s --check-prefix=MANGLED
// CHECK: undefined symbol 'geometry::length(geometry::vector const&, float)' (in function 'geometry::use(float)')
// MANGLED: undefined symbol '_ZN8geometry6lengthERKNS_6vectorEf' (in function '_ZN8geometry3useEf')
// RUN: %clangxx -DDEFINED %s -Wl,--print-stack -o %t | FileCheck %s --check-prefix=STACK
// STACK: geometry::length(geometry::vector const&, float)
namespace geometry {
struct vector { float x, y, z; };
float length(const vector &, float);
#ifdef DEFINED
__attribute__((noinline)) float length(const vector &v, float scale) { volatile float parts[4] = {v.x, v.y, v.z, scale}; return parts[0] * parts[3]; }
#endif
__attribute__((noinline)) float use(float x) { vector v{x, x, x}; return length(v, 2) + 1; }
} // namespace geometry
int main(int argc, char **) { return int(geometry::use(float(argc))); }
