/* The public headers that the package `trax` declares to cffi, and whose functions the shared library has. */
#include "trax/emulator.h"
#include "trax/explain.h"
#include "trax/manifest.h"
