/* erfcf in binary64: newlib's is off by 60 units in the last place. */
#include <math.h>

float erfcf(float x) {
  return (float)erfc((double)x);
}
