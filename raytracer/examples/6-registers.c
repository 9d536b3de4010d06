/* Step 6: everything in registers. The ray to the light goes through the same copy of the traversal as the one from the
   eye, and that copy stands within the loop over pixels: no call saves registers, no pointer keeps the ray in memory,
   and the program stays small. The second child's box is tested in one place where the first one was entered and in
   another where it was missed, so that what was found needs no variable. */
#include "traversal.h"

#include "registers.h"

struct trax_buffer scene, params, image;
unsigned next_pixel; /* shared by all threads */

int main(void) {
  const struct trax_render_params *frame = params.data;
  check_input(frame, scene.data);
  unsigned pixels = frame->width * frame->height;
  for (unsigned pixel = trax_atomic_inc(&next_pixel); pixel < pixels; pixel = trax_atomic_inc(&next_pixel)) {
    trax_store_nt((unsigned *)image.data + pixel, render(frame, pixel % frame->width, pixel / frame->width));
    trax_count_items(1);
  }
  return 0;
}
