#ifndef TRAX_DEVICE_VECTOR_H
#define TRAX_DEVICE_VECTOR_H

/* A point, a direction or a colour. */
struct vector {
  float x, y, z;
};

#endif
