// RUN: %run_c %s %t --slow --cflags "-mstack=global -std=c++20"
// libc++'s headers, a little of each that a program for the TP may want: what clang++ prints for the host.
#include <algorithm>
#include <any>
#include <array>
#include <atomic>
#include <bit>
#include <bitset>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <deque>
#include <functional>
#include <iterator>
#include <limits>
#include <list>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <queue>
#include <random>
#include <ranges>
#include <set>
#include <span>
#include <stack>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

struct Base {
  virtual int f() const = 0;
  virtual ~Base() { std::printf("~Base\n"); }
};
struct D : Base {
  int v;
  explicit D(int v) : v(v) {}
  int f() const override { return v; }
};
static std::vector<int> global{3, 1, 2};
int main() {
  std::sort(global.begin(), global.end());
  for (int x : global)
    std::printf("%d ", x);
  std::map<std::string, int> m{{"one", 1}, {"two", 2}};
  m["three with a long key that is allocated"] = 3;
  for (auto &[k, v] : m)
    std::printf("%s=%d ", k.c_str(), v);
  std::unordered_map<int, std::string> u;
  for (int i = 0; i < 50; i++)
    u[i * 7] = std::to_string(i);
  std::printf("%s %zu\n", u[49].c_str(), u.size());
  std::unique_ptr<Base> p = std::make_unique<D>(42);
  std::printf("%d\n", p->f());
  auto sp = std::make_shared<D>(43);
  auto sp2 = sp;
  std::printf("%d %ld\n", sp2->f(), sp.use_count());
  std::function<int(int)> fn = [k = 5](int x) { return x + k; };
  std::printf("%d\n", fn(2));
  std::variant<int, float, std::string> va = std::string("text");
  std::visit(
      [](auto &x) {
        if constexpr (std::is_same_v<std::decay_t<decltype(x)>, std::string>)
          std::printf("%s\n", x.c_str());
      },
      va);
  std::optional<int> o;
  std::printf("%d %d\n", o.value_or(7), (int)o.has_value());
  std::priority_queue<int> q;
  q.push(3);
  q.push(9);
  q.push(4);
  std::printf("%d\n", q.top());
  std::mt19937 gen(1);
  std::printf("%u\n", (unsigned)gen());
  std::array<float, 3> a{1, 2, 3};
  std::printf("%g\n", (double)std::accumulate(a.begin(), a.end(), 0.0f));
  std::bitset<40> b(5);
  std::printf("%zu\n", b.count());
  char buf[20];
  auto r = std::to_chars(buf, buf + 20, 12345);
  *r.ptr = 0;
  std::printf("%s\n", buf);
  int parsed;
  {
    const char *t = "678";
    std::from_chars(t, t + 3, parsed);
  };
  std::printf("%d\n", parsed);
  auto view = global | std::views::transform([](int x) { return x * x; });
  for (int x : view)
    std::printf("%d ", x);
  std::printf("%g\n", std::sqrt(2.0));
  std::list<int> l{1, 2, 3};
  l.reverse();
  std::printf("%d\n", l.front());
  std::deque<int> dq{1, 2, 3};
  dq.push_front(0);
  std::printf("%d\n", dq[0]);
  std::set<int> s{3, 1, 2};
  std::printf("%d\n", *s.begin());
  std::string str = "hello";
  str += " world, this is a longer string";
  std::printf("%s %zu\n", str.c_str(), str.find("world"));
  std::any anything = 3;
  std::printf("%d\n", std::any_cast<int>(anything));
  std::vector<double> numbers{3.5, -1, 2};
  std::sort(numbers.begin(), numbers.end());
  std::vector<std::string> words{"pear", "apple", "fig"};
  std::sort(words.begin(), words.end(), [](auto &a, auto &b) { return a.size() < b.size(); });
  std::printf("%g %s %d %s\n", numbers[0], words[0].c_str(), std::stoi("-17"), std::to_string(2.5).c_str());
  size_t used;
  std::printf("%g %zu %g\n", std::stod("2.5e3 more", &used), used, static_cast<double>(std::stof("-0.125")));
  std::weak_ptr<D> weak = sp;
  sp.reset();
  sp2.reset();
  std::printf("%d %d\n", weak.expired(), weak.lock() == nullptr);
  auto moved = std::move(words);
  std::printf("%zu %zu %d\n", moved.size(), words.size(), std::popcount(0xF0u));
  constexpr std::string_view text = "a view";
  static_assert(text.substr(2) == "view");
  std::tuple t{1, 2.0, 'c'};
  std::printf("%d %c %g\n", std::get<0>(t), std::get<2>(t), std::numbers::pi);
  float data[4] = {4, 3, 2, 1};
  std::span<float> part(data, 3);
  std::ranges::sort(part);
  std::printf("%g %g %zu\n", static_cast<double>(part.front()), static_cast<double>(data[3]), part.size());
  return 0;
}
