// RUN: %run_c %s %t --turns -O0,-O2,-Os --cflags "-mstack=global -std=c++20"
// C++ without exceptions and type information, as far as the language goes: what clang++ prints for the host.
#include <compare>
#include <initializer_list>
#include <new>
#include <stdio.h>
#include <stdlib.h>

namespace shapes {

struct Named {
  const char *name;
  explicit Named(const char *name) : name(name) { printf("Named(%s)\n", name); }
  Named(const Named &other) : name(other.name) { printf("copy of %s\n", name); }
  Named(Named &&other) noexcept : name(other.name) {
    other.name = "nothing";
    printf("move of %s\n", name);
  }
  virtual ~Named() { printf("~Named(%s)\n", name); }
  virtual const char *kind() const { return "named"; }
};

struct Area {
  int pad = 7;
  virtual int area() const = 0;
  virtual ~Area() = default;
};

struct Rectangle : Named, Area {
  int width, height;
  Rectangle(int width, int height) : Named("rectangle"), width(width), height(height) {}
  int area() const override { return width * height; }
  const char *kind() const override { return "rectangle"; }
  ~Rectangle() override { printf("~Rectangle %d\n", area()); }
};

struct Square final : Rectangle {
  explicit Square(int side) : Rectangle(side, side) {}
  const char *kind() const override { return "square"; }
};

struct Left : virtual Area {
  int left = 1;
};
struct Right : virtual Area {
  int right = 2;
};
struct Both : Left, Right {
  int area() const override { return left + right + pad; }
};

} // namespace shapes

using namespace shapes;

template <typename T, int N> struct Stack {
  T items[N];
  int count = 0;
  constexpr void push(const T &item) { items[count++] = item; }
  constexpr T pop() { return items[--count]; }
};
template <typename T> struct Stack<T *, 1> { T *only = nullptr; };

template <typename... Values> constexpr auto sum(Values... values) {
  return (values + ... + 0);
}

template <typename T>
concept Sized = requires(T x) {
  x.area();
};
template <Sized T> int twice(const T &x) {
  return 2 * x.area();
}

constexpr int computed() {
  Stack<int, 8> s;
  for (int i = 0; i < 8; i++)
    s.push(i * i);
  int total = 0;
  while (s.count)
    total = total * 2 + s.pop();
  return total;
}
static_assert(computed() == 9722);

struct Order {
  int n;
  Order(int n) : n(n) { printf("construct %d\n", n); }
  ~Order() { printf("destroy %d\n", n); }
};
static Order first(1), second(2);
static Order &local() {
  static Order object(3);
  return object;
}
int dynamic = printf("a global's initialiser\n");

struct Operations {
  int value;
  int add(int x) { return value += x; }
  int scale(int x) { return value *= x; }
};

struct Vec {
  float x, y, z;
  friend Vec operator+(Vec a, Vec b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec operator*(float s, Vec a) { return {s * a.x, s * a.y, s * a.z}; }
  auto operator<=>(const Vec &) const = default;
};

static Rectangle make(int n) {
  Rectangle r(n, n + 1);
  return r;
}

static void byValue(Named n) {
  printf("got %s\n", n.name);
}

enum class Colour : unsigned char { red = 1, green };

int main() {
  {
    Square square(5);
    const Named *named = &square;
    const Area *area = &square;
    printf("%s %d %d\n", named->kind(), area->area(), twice(square));
    byValue(square);
    Both both;
    printf("%d\n", static_cast<Area &>(both).area());
  }
  printf("%d\n", make(3).area());
  Area *owned = new Rectangle(2, 9);
  printf("%d\n", owned->area());
  delete owned;
  Order *many = new Order[2]{10, 11};
  delete[] many;
  alignas(Order) unsigned char place[sizeof(Order)];
  Order *placed = new (place) Order(20);
  placed->~Order();

  int (Operations::*operation)(int) = &Operations::add;
  Operations object{4};
  int first_result = (object.*operation)(3);
  operation = &Operations::scale;
  printf("%d %d\n", first_result, (object.*operation)(2));
  int Operations::*member = &Operations::value;
  int (Area::*virtual_member)() const = &Area::area;
  Both both;
  printf("%d %d\n", object.*member, (both.*virtual_member)());

  int captured = 3;
  auto counter = [captured, calls = 0](int x) mutable { return captured * x + ++calls; };
  printf("%d %d\n", counter(2), counter(2));
  auto generic = [&](auto x) { return x + captured; };
  captured = 10;
  printf("%d %.1f\n", generic(1), static_cast<double>(generic(0.5f)));
  int (*plain)(int) = [](int x) { return -x; };
  printf("%d %d\n", plain(4), sum(1, 2, 3, 4));

  printf("local: %d %d\n", local().n, local().n);
  Vec v = Vec{1, 2, 3} + 2 * Vec{1, 0, 1};
  printf("%.0f %.0f %.0f %d\n", static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z),
         v < Vec{3, 2, 6});
  printf("%d %d\n", static_cast<int>(Colour::green), Stack<int *, 1>().only == nullptr);
  if (auto [x, y] = Stack<int, 2>{{8, 9}, 0}.items; x < y)
    printf("%d %d\n", x, y);
  for (int i : {1, 2, 3})
    printf("%d ", i);
  puts("end of main");
  atexit([] { puts("atexit"); });
  return dynamic == 0;
}
