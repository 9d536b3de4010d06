#include "radiance.h"

#include "layers.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <tinyexr.h>

trax_status trax_radiance_allocate(struct trax_picture *picture, uint64_t width, uint64_t height, const char *name,
                                   trax_error *error) {
  if (width == 0 || height == 0 || width > TRAX_RENDER_MAX_SIDE || height > TRAX_RENDER_MAX_SIDE)
    return trax_fail(error, "%s: a picture of %llu x %llu; width and height must be 1 to %u", name,
                     (unsigned long long)width, (unsigned long long)height, TRAX_RENDER_MAX_SIDE);
  picture->width = (uint32_t)width;
  picture->height = (uint32_t)height;
  picture->radiance = calloc(3 * width * height, sizeof *picture->radiance);
  return picture->radiance
             ? TRAX_OK
             : trax_fail(error, "out of memory for a picture of %u x %u", picture->width, picture->height);
}

/* --- PFM: a line of text each for kind, size and byte order, then rows from the bottom up --- */

trax_status trax_pfm_encode(struct trax_bytes *bytes, const struct trax_picture *picture, const char *name,
                            trax_error *error) {
  char header[64];
  const int length = snprintf(header, sizeof header, "PF\n%u %u\n-1.0\n", picture->width, picture->height);
  const size_t row = 3 * sizeof(float) * picture->width;
  *bytes = (struct trax_bytes){0};
  bytes->size = (size_t)length + row * picture->height;
  if (!(bytes->data = malloc(bytes->size)))
    return trax_fail(error, "%s: out of memory", name);
  memcpy(bytes->data, header, (size_t)length);
  for (uint32_t y = 0; y < picture->height; y++)
    memcpy(bytes->data + (size_t)length + y * row,
           picture->radiance + 3 * (size_t)(picture->height - 1 - y) * picture->width, row);
  return TRAX_OK;
}

bool trax_is_pfm(const uint8_t *bytes, size_t size) {
  return size > 3 && bytes[0] == 'P' && (bytes[1] == 'F' || bytes[1] == 'f') &&
         (bytes[2] == '\n' || bytes[2] == '\r' || bytes[2] == ' ');
}

static bool is_space(uint8_t c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

/* The next word of the header, of fewer than 32 characters; a single space is behind it. */
static bool take_word(char word[32], const uint8_t **at, const uint8_t *end) {
  size_t length = 0;
  while (*at < end && is_space(**at))
    ++*at;
  while (*at < end && !is_space(**at) && length < 31)
    word[length++] = (char)*(*at)++;
  word[length] = 0;
  if (length == 0 || *at == end || !is_space(**at))
    return false;
  ++*at;
  return true;
}

trax_status trax_pfm_decode(struct trax_picture *picture, const uint8_t *bytes, size_t size, const char *name,
                            trax_error *error) {
  const uint8_t *at = bytes + 2, *end = bytes + size;
  const unsigned channels = bytes[1] == 'F' ? 3 : 1;
  char words[3][32], *rest[3];
  *picture = (struct trax_picture){0};
  for (int i = 0; i < 3; i++)
    if (!take_word(words[i], &at, end))
      return trax_fail(error, "%s: not a readable PFM: its header has no size and scale", name);
  const unsigned long width = strtoul(words[0], &rest[0], 10), height = strtoul(words[1], &rest[1], 10);
  const double scale = strtod(words[2], &rest[2]);
  if (words[0][0] == '-' || words[1][0] == '-' || *rest[0] || *rest[1] || *rest[2] || !(scale < 0 || scale > 0))
    return trax_fail(error, "%s: not a readable PFM: its header has no size and scale", name);
  if (width <= TRAX_RENDER_MAX_SIDE && height <= TRAX_RENDER_MAX_SIDE &&
      (uint64_t)(end - at) < (uint64_t)channels * sizeof(float) * width * height)
    return trax_fail(error, "%s: not a readable PFM: cut off", name);
  if (trax_radiance_allocate(picture, width, height, name, error) != TRAX_OK)
    return TRAX_ERROR;
  for (size_t i = 0; i < 3 * (size_t)width * height; i++) {
    const size_t x = i / 3 % width, y = height - 1 - i / 3 / width, channel = channels == 3 ? i % 3 : 0;
    const uint8_t *from = at + sizeof(float) * (channels * (y * width + x) + channel);
    uint32_t word = 0;
    for (int byte = 0; byte < 4; byte++)
      word |= (uint32_t)from[scale < 0 ? byte : 3 - byte] << 8 * byte;
    memcpy(&picture->radiance[i], &word, sizeof word);
  }
  return TRAX_OK;
}

/* --- EXR, by tinyexr --- */

/* The channels in the order that the format asks for: that of their names. */
static const struct channel {
  const char *name;
  int type;
  bool layer;    /* of struct trax_layers, else of three floats */
  size_t offset; /* in it */
} channels[] = {{"B", TINYEXR_PIXELTYPE_FLOAT, false, 2 * sizeof(float)},
                {"G", TINYEXR_PIXELTYPE_FLOAT, false, sizeof(float)},
                {"N.X", TINYEXR_PIXELTYPE_FLOAT, true, offsetof(struct trax_layers, normal)},
                {"N.Y", TINYEXR_PIXELTYPE_FLOAT, true, offsetof(struct trax_layers, normal) + sizeof(float)},
                {"N.Z", TINYEXR_PIXELTYPE_FLOAT, true, offsetof(struct trax_layers, normal) + 2 * sizeof(float)},
                {"R", TINYEXR_PIXELTYPE_FLOAT, false, 0},
                {"Z", TINYEXR_PIXELTYPE_FLOAT, true, offsetof(struct trax_layers, depth)},
                {"shadow", TINYEXR_PIXELTYPE_UINT, true, offsetof(struct trax_layers, shadow)},
                {"triangle", TINYEXR_PIXELTYPE_UINT, true, offsetof(struct trax_layers, triangle)}};
enum { CHANNELS = sizeof channels / sizeof *channels };

/* The channel's word of a pixel. */
static char *word_of(const struct trax_picture *picture, const struct channel *channel, size_t pixel) {
  return channel->layer ? (char *)&picture->layers[pixel] + channel->offset
                        : (char *)&picture->radiance[3 * pixel] + channel->offset;
}

trax_status trax_exr_encode(struct trax_bytes *bytes, const struct trax_picture *picture, const char *name,
                            trax_error *error) {
  const size_t pixels = (size_t)picture->width * picture->height;
  EXRHeader header;
  EXRImage image;
  EXRChannelInfo infos[CHANNELS] = {0};
  int types[CHANNELS];
  unsigned char *planes[CHANNELS];
  const char *reason = NULL;
  InitEXRHeader(&header);
  InitEXRImage(&image);
  *bytes = (struct trax_bytes){0};
  unsigned char *memory = malloc(CHANNELS * pixels * sizeof(float));
  if (!memory)
    return trax_fail(error, "%s: out of memory", name);
  for (int i = 0; i < CHANNELS; i++) {
    if (channels[i].layer && !picture->layers)
      continue;
    unsigned char *plane = memory + (size_t)header.num_channels * pixels * sizeof(float);
    for (size_t pixel = 0; pixel < pixels; pixel++)
      memcpy(plane + pixel * sizeof(float), word_of(picture, &channels[i], pixel), sizeof(float));
    snprintf(infos[header.num_channels].name, sizeof infos->name, "%s", channels[i].name);
    types[header.num_channels] = channels[i].type;
    planes[header.num_channels++] = plane;
  }
  header.channels = infos;
  header.pixel_types = header.requested_pixel_types = types;
  header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
  image.num_channels = header.num_channels;
  image.images = planes;
  image.width = (int)picture->width;
  image.height = (int)picture->height;
  bytes->size = SaveEXRImageToMemory(&image, &header, &bytes->data, &reason);
  free(memory);
  if (bytes->size > 0)
    return TRAX_OK;
  trax_fail(error, "%s: cannot make an EXR: %s", name, reason ? reason : "out of memory");
  FreeEXRErrorMessage(reason);
  return TRAX_ERROR;
}

bool trax_is_exr(const uint8_t *bytes, size_t size) {
  static const uint8_t magic[] = {0x76, 0x2F, 0x31, 0x01};
  return size > sizeof magic && memcmp(bytes, magic, sizeof magic) == 0;
}

/* The places of our channels among the file's; -1 for missing ones. */
static unsigned find_channels(int place[CHANNELS], const EXRHeader *header) {
  unsigned found = 0;
  for (int i = 0; i < CHANNELS; i++) {
    place[i] = -1;
    for (int j = 0; j < header->num_channels; j++)
      if (!strcmp(header->channels[j].name, channels[i].name) &&
          (header->pixel_types[j] == TINYEXR_PIXELTYPE_UINT) == (channels[i].type == TINYEXR_PIXELTYPE_UINT))
        place[i] = j, found |= 1u << i;
  }
  return found;
}

/* Whether the file is one part of scan lines. The library ends the program at a header that gives another type, or none
   that exists. What is damaged otherwise is left to it. */
static bool has_scan_lines(const EXRVersion *version, const uint8_t *bytes, size_t size) {
  static const char right[] = "scanlineimage";
  const char *at = (const char *)bytes + 8; /* behind magic and version: name, type, size and value of each attribute */
  const char *const end = (const char *)bytes + size;
  while (at < end && *at) {
    const char *name = at, *type = memchr(name, 0, (size_t)(end - name));
    const char *value = type ? memchr(type + 1, 0, (size_t)(end - type - 1)) : NULL;
    uint32_t length;
    if (!value || end - value - 1 < (ptrdiff_t)sizeof length)
      break;
    memcpy(&length, value + 1, sizeof length);
    value += 1 + sizeof length;
    if (length > (size_t)(end - value))
      break;
    if (strcmp(name, "type") == 0 && (length != sizeof right - 1 || memcmp(value, right, length) != 0))
      return false;
    at = value + length;
  }
  return !version->multipart && !version->non_image && !version->tiled;
}

/* Returns why the file cannot be read, or NULL. bytes: of the file. */
static const char *check_exr(EXRHeader *header, int64_t width, int64_t height, size_t bytes) {
  enum { MOST_RATIO = 1100 }; /* of bytes to packed bytes: RLE and deflate have less */
  if (header->compression_type < TINYEXR_COMPRESSIONTYPE_NONE || header->compression_type > TINYEXR_COMPRESSIONTYPE_ZIP)
    return "it is packed by another method than RLE and ZIP";
  for (int i = 0; i < header->num_channels; i++) {
    if (header->channels[i].x_sampling != 1 || header->channels[i].y_sampling != 1)
      return "a channel has fewer samples than pixels";
    if (header->pixel_types[i] == TINYEXR_PIXELTYPE_HALF)
      header->requested_pixel_types[i] = TINYEXR_PIXELTYPE_FLOAT;
  }
  if (width > 0 && height > 0 &&
      (uint64_t)width * (uint64_t)height * (uint64_t)header->num_channels * 2 / MOST_RATIO > bytes)
    return "cut off";
  return NULL;
}

/* Every layer of the file is needed. */
static const unsigned all_channels = (1u << CHANNELS) - 1, colours = 1u << 0 | 1u << 1 | 1u << 5;

static trax_status take_image(struct trax_picture *picture, const EXRHeader *header, const EXRImage *image,
                              const char *name, trax_error *error) {
  int place[CHANNELS];
  const unsigned found = find_channels(place, header);
  if ((found & colours) != colours)
    return trax_fail(error, "%s: not a readable EXR: it has no channels R, G and B of floats", name);
  const size_t pixels = (size_t)picture->width * picture->height;
  if (found == all_channels && !(picture->layers = calloc(pixels, sizeof *picture->layers)))
    return trax_fail(error, "out of memory for the layers of %u x %u pixels", picture->width, picture->height);
  for (int i = 0; i < CHANNELS; i++)
    for (size_t pixel = 0; pixel < pixels && (picture->layers || !channels[i].layer); pixel++)
      memcpy(word_of(picture, &channels[i], pixel), image->images[place[i]] + pixel * sizeof(float), sizeof(float));
  return TRAX_OK;
}

trax_status trax_exr_decode(struct trax_picture *picture, const uint8_t *bytes, size_t size, const char *name,
                            trax_error *error) {
  EXRVersion version;
  EXRHeader header;
  EXRImage image;
  const char *reason = NULL;
  trax_status status = TRAX_OK;
  *picture = (struct trax_picture){0};
  InitEXRHeader(&header);
  InitEXRImage(&image);
  const bool known = ParseEXRVersionFromMemory(&version, bytes, size) == TINYEXR_SUCCESS;
  if (known && !has_scan_lines(&version, bytes, size))
    return trax_fail(error, "%s: not a readable EXR: it is not one part of scan lines", name);
  if (!known || ParseEXRHeaderFromMemory(&header, &version, bytes, size, &reason) != TINYEXR_SUCCESS) {
    trax_fail(error, "%s: not a readable EXR: %s", name, reason ? reason : "it has no header");
    FreeEXRErrorMessage(reason);
    return TRAX_ERROR;
  }
  const EXRBox2i window = header.data_window;
  const int64_t width = (int64_t)window.max_x - window.min_x + 1, height = (int64_t)window.max_y - window.min_y + 1;
  const char *wrong = check_exr(&header, width, height, size);
  if (wrong)
    status = trax_fail(error, "%s: not a readable EXR: %s", name, wrong);
  if (status == TRAX_OK)
    status = trax_radiance_allocate(picture, (uint64_t)(width > 0 ? width : 0), (uint64_t)(height > 0 ? height : 0),
                                    name, error);
  if (status == TRAX_OK && LoadEXRImageFromMemory(&image, &header, bytes, size, &reason) != TINYEXR_SUCCESS) {
    status = trax_fail(error, "%s: not a readable EXR: %s", name, reason ? reason : "its data are damaged");
  } else if (status == TRAX_OK) {
    status = take_image(picture, &header, &image, name, error);
    FreeEXRImage(&image); /* the library has freed an image that it cannot load */
  }
  FreeEXRErrorMessage(reason);
  FreeEXRHeader(&header);
  return status;
}
