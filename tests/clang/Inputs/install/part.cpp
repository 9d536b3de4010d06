#include "device.h"
#include <numeric>
#include <vector>
int sum_below(int n) {
  std::vector<int> numbers(static_cast<unsigned>(n));
  std::iota(numbers.begin(), numbers.end(), 0);
  return std::accumulate(numbers.begin(), numbers.end(), 0);
}
