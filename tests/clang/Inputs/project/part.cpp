namespace {
template <int N> int add(int x) { return x + N; }
} // namespace
extern "C" int part(int x) { return add<0>(x); }
