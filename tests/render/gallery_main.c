/* render-gallery DIRECTORY [PARTS]: gallery.trax with those parts, a sum of gallery.h's (63: all), and gallery.view
   with all lights. The directory is made if it is not there. For tests of programs, and to look at. */
#include "gallery.h"
#include "trax/output.h"

#include <stdlib.h>
#include <sys/stat.h>

static const char view_text[] =
    "eye = [0.05, 1.05, 3.9];\ndirection = [0.0, -0.03, -1.0];\nup = [0.0, 1.0, 0.0];\nfov = 38.0;\n"
    "lights = (\n"
    "  { type = \"point\"; position = [0.2, 1.7, 0.9]; colour = [1.0, 0.9, 0.7]; strength = 0.5; falloff = 1.2; },\n"
    "  { type = \"directional\"; direction = [0.36, -0.48, -0.8]; colour = [0.7, 0.8, 1.0]; strength = 0.4; },\n"
    "  { type = \"rectangle\"; corner = [-0.3, 1.9, 0.4]; edges = ( [0.6, 0.0, 0.0], [0.0, 0.0, 0.4] ); strength = "
    "4.0; }\n"
    ");\n";

int main(int argc, char **argv) {
  trax_error error;
  char path[4096];
  if (argc < 2 || argv[1][0] == '-') {
    fprintf(stderr, "usage: render-gallery DIRECTORY [PARTS]\n");
    return 2;
  }
  struct trax_scene scene = gallery_scene(argc > 2 ? (unsigned)atoi(argv[2]) : GALLERY_ALL);
  mkdir(argv[1], 0777); /* what went wrong is told where it is written to */
  snprintf(path, sizeof path, "%s/gallery.trax", argv[1]);
  trax_status status = trax_scene_write(&scene, path, &error);
  snprintf(path, sizeof path, "%s/gallery.view", argv[1]);
  if (status == TRAX_OK)
    status = trax_write_file(path, view_text, sizeof view_text - 1, &error);
  if (status != TRAX_OK)
    fprintf(stderr, "render-gallery: error: %s\n", error.message);
  trax_scene_release(&scene);
  return status != TRAX_OK;
}
