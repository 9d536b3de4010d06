/* The bodies of kernels/n_body.c in single precision: square roots and fused multiply-adds. */
#define REAL float
#define STEPS 200
#include "../kernels/n_body.c"
