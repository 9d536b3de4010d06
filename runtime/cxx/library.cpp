// The compiled functions that libc++'s headers expect, in forms that suit a small stack.
#include "../internal/machine.h"

#include <algorithm>
#include <charconv>
#include <exception>
#include <memory>
#include <string>

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

_LIBCPP_BEGIN_NAMESPACE_STD

// The functions that replace libc++'s exceptions, and those for its failed checks.
void __libcpp_verbose_abort(const char *format, ...) {
  static char text[256]; // global, so that the host can read it; of two threads that write at once, one prints
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  machine_abort(text);
}

// --- std::sort of numbers: a heapsort, without recursion

template <class Compare, class Iterator> void __sort(Iterator first, Iterator last, Compare) { // which is operator<
  std::make_heap(first, last);
  std::sort_heap(first, last);
}

#define SORT(type) template void __sort<__less<type> &, type *>(type *, type *, __less<type> &);
SORT(char)
SORT(signed char)
SORT(unsigned char)
SORT(short)
SORT(unsigned short)
SORT(int)
SORT(unsigned)
SORT(long)
SORT(unsigned long)
SORT(long long)
SORT(unsigned long long)
SORT(float)
SORT(double)
SORT(long double)

// --- std::unordered_map: the least prime that is not below n

static bool is_prime(unsigned n) {
  for (unsigned divisor = 3; divisor <= n / divisor; divisor += 2)
    if (n % divisor == 0)
      return false;
  return true;
}

size_t __next_prime(size_t n) {
  if (n <= 2)
    return n; // 0: no buckets
  if (n > 0xFFFFFFFBu)
    machine_abort("a hash table is too large");
  n |= 1;
  while (!is_prime(n))
    n += 2;
  return n;
}

// --- std::shared_ptr: counts are of owners beyond the first

__shared_count::~__shared_count() {}
__shared_weak_count::~__shared_weak_count() {}

void __shared_weak_count::__release_weak() noexcept {
  if (__libcpp_atomic_refcount_decrement(__shared_weak_owners_) == -1)
    __on_zero_shared_weak();
}

__shared_weak_count *__shared_weak_count::lock() noexcept {
  long owners = __libcpp_acquire_load(&__shared_owners_);
  while (owners != -1)
    if (__atomic_compare_exchange_n(&__shared_owners_, &owners, owners + 1, true, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST))
      return this;
  return nullptr;
}

const void *__shared_weak_count::__get_deleter(const type_info &) const noexcept {
  return nullptr; // there is no type information to compare with
}

// --- std::string and numbers

namespace {

template <class Number> string from_integer(Number value) {
  char digits[24];
  return string(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

string from_double(double value) {
  string text(static_cast<size_t>(snprintf(nullptr, 0, "%f", value)), '\0');
  snprintf(text.data(), text.size() + 1, "%f", value);
  return text;
}

/* The number at the beginning of text; *used receives where it ends. */
template <class Number, class... Base>
Number from_text(const string &text, size_t *used, Number (*convert)(const char *, char **, Base...), Base... base) {
  char *end;
  errno = 0;
  const Number value = convert(text.c_str(), &end, base...);
  if (end == text.c_str())
    machine_abort("std::stoi or one of its like: not a number");
  if (errno == ERANGE)
    machine_abort("std::stoi or one of its like: the number is out of range");
  if (used)
    *used = static_cast<size_t>(end - text.c_str());
  return value;
}

} // namespace

string to_string(int value) {
  return from_integer(value);
}
string to_string(unsigned value) {
  return from_integer(value);
}
string to_string(long value) {
  return from_integer(value);
}
string to_string(unsigned long value) {
  return from_integer(value);
}
string to_string(long long value) {
  return from_integer(value);
}
string to_string(unsigned long long value) {
  return from_integer(value);
}
string to_string(float value) {
  return from_double(static_cast<double>(value));
}
string to_string(double value) {
  return from_double(value);
}
string to_string(long double value) {
  return from_double(static_cast<double>(value));
}

int stoi(const string &text, size_t *used, int base) {
  return static_cast<int>(from_text(text, used, strtol, base)); // a long is an int
}
long stol(const string &text, size_t *used, int base) {
  return from_text(text, used, strtol, base);
}
unsigned long stoul(const string &text, size_t *used, int base) {
  return from_text(text, used, strtoul, base);
}
long long stoll(const string &text, size_t *used, int base) {
  return from_text(text, used, strtoll, base);
}
unsigned long long stoull(const string &text, size_t *used, int base) {
  return from_text(text, used, strtoull, base);
}
float stof(const string &text, size_t *used) {
  return from_text(text, used, strtof);
}
double stod(const string &text, size_t *used) {
  return from_text(text, used, strtod);
}
long double stold(const string &text, size_t *used) {
  return from_text(text, used, strtold);
}

_LIBCPP_END_NAMESPACE_STD

// --- exceptions as objects: nothing throws them

std::exception::~exception() noexcept {}
const char *std::exception::what() const noexcept {
  return "std::exception";
}
