#include "radiance.h"

#include <OpenEXR/openexr.h>
#include <stdlib.h>
#include <string.h>

/* Makes room up to `end`. */
static bool reach(struct trax_bytes *bytes, size_t end) {
  if (end > bytes->capacity) {
    size_t capacity = bytes->capacity ? bytes->capacity : 1 << 16;
    while (capacity < end)
      capacity *= 2;
    uint8_t *data = realloc(bytes->data, capacity);
    if (!data)
      return false;
    memset(data + bytes->capacity, 0, capacity - bytes->capacity);
    bytes->data = data;
    bytes->capacity = capacity;
  }
  if (end > bytes->size)
    bytes->size = end;
  return true;
}

static trax_status allocate(struct trax_picture *picture, uint64_t width, uint64_t height, const char *name,
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
  if (!reach(bytes, (size_t)length + row * picture->height))
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
  if (allocate(picture, width, height, name, error) != TRAX_OK)
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

/* --- EXR, by OpenEXR's C library --- */

struct stream {
  struct trax_bytes *out;
  const uint8_t *in;
  size_t size;
  char reason[200];
};

static struct stream *stream_of(exr_const_context_t context) {
  void *stream = NULL;
  return exr_get_user_data(context, &stream) == EXR_ERR_SUCCESS ? stream : NULL;
}

static void remember(exr_const_context_t context, exr_result_t code, const char *message) {
  struct stream *stream = stream_of(context);
  (void)code;
  if (stream && !stream->reason[0])
    snprintf(stream->reason, sizeof stream->reason, "%s", message);
}

static int64_t read_stream(exr_const_context_t context, void *user, void *buffer, uint64_t size, uint64_t offset,
                           exr_stream_error_func_ptr_t fail) {
  const struct stream *stream = user;
  (void)context, (void)fail;
  if (offset > stream->size)
    return -1;
  const uint64_t left = stream->size - offset, count = size < left ? size : left;
  memcpy(buffer, stream->in + offset, count);
  return (int64_t)count;
}

static int64_t size_stream(exr_const_context_t context, void *user) {
  (void)context;
  return (int64_t)((const struct stream *)user)->size;
}

static int64_t write_stream(exr_const_context_t context, void *user, const void *buffer, uint64_t size, uint64_t offset,
                            exr_stream_error_func_ptr_t fail) {
  struct stream *stream = user;
  (void)context, (void)fail;
  if (!reach(stream->out, offset + size))
    return -1;
  memcpy(stream->out->data + offset, buffer, size);
  return (int64_t)size;
}

static exr_context_initializer_t initializer(struct stream *stream) {
  exr_context_initializer_t result = EXR_DEFAULT_CONTEXT_INITIALIZER;
  result.error_handler_fn = remember;
  result.user_data = stream;
  result.max_image_width = result.max_image_height = (int)TRAX_RENDER_MAX_SIDE;
  return result;
}

/* EXR has its channels in the order of their names. */
static const char *const channel_names[3] = {"R", "G", "B"};

static int channel_number(const char *name) {
  for (int i = 0; i < 3; i++)
    if (!strcmp(name, channel_names[i]))
      return i;
  return -1;
}

struct compressor {
  exr_result_t (*function)(exr_encode_pipeline_t *);
};

/* A chunk as long as its data stands for the data themselves, so it must be them. The library (3.1.5) leaves packed
   data there if they happen to be of that very length. */
static exr_result_t compress_chunk(exr_encode_pipeline_t *encoder) {
  const struct compressor *compressor = encoder->encoding_user_data;
  const exr_result_t result = compressor->function(encoder);
  if (result == EXR_ERR_SUCCESS && encoder->compressed_bytes == encoder->packed_bytes)
    memcpy(encoder->compressed_buffer, encoder->packed_buffer, encoder->packed_bytes);
  return result;
}

static exr_result_t write_lines(exr_context_t context, const struct trax_picture *picture) {
  int32_t lines;
  exr_encode_pipeline_t encoder = EXR_ENCODE_PIPELINE_INITIALIZER;
  struct compressor compressor;
  bool begun = false;
  exr_result_t result = exr_get_scanlines_per_chunk(context, 0, &lines);
  for (uint32_t y = 0; result == EXR_ERR_SUCCESS && y < picture->height; y += (uint32_t)lines) {
    exr_chunk_info_t chunk;
    result = exr_write_scanline_chunk_info(context, 0, (int)y, &chunk);
    if (result == EXR_ERR_SUCCESS)
      result = begun ? exr_encoding_update(context, 0, &chunk, &encoder)
                     : exr_encoding_initialize(context, 0, &chunk, &encoder);
    for (int i = 0; result == EXR_ERR_SUCCESS && i < encoder.channel_count; i++) {
      const int channel = channel_number(encoder.channels[i].channel_name);
      encoder.channels[i].user_bytes_per_element = sizeof(float);
      encoder.channels[i].user_data_type = EXR_PIXEL_FLOAT;
      encoder.channels[i].user_pixel_stride = 3 * sizeof(float);
      encoder.channels[i].user_line_stride = 3 * (int32_t)sizeof(float) * (int32_t)picture->width;
      encoder.channels[i].encode_from_ptr =
          (const uint8_t *)(picture->radiance + 3 * (size_t)y * picture->width + channel);
    }
    if (result == EXR_ERR_SUCCESS && !begun) {
      result = exr_encoding_choose_default_routines(context, 0, &encoder);
      compressor.function = encoder.compress_fn;
      encoder.encoding_user_data = &compressor;
      encoder.compress_fn = compress_chunk;
    }
    begun = true;
    if (result == EXR_ERR_SUCCESS)
      result = exr_encoding_run(context, 0, &encoder);
  }
  if (begun)
    exr_encoding_destroy(context, &encoder);
  return result;
}

trax_status trax_exr_encode(struct trax_bytes *bytes, const struct trax_picture *picture, const char *name,
                            trax_error *error) {
  struct stream stream = {.out = bytes};
  exr_context_initializer_t options = initializer(&stream);
  exr_context_t context = NULL;
  int part;
  options.write_fn = write_stream;
  *bytes = (struct trax_bytes){0};
  exr_result_t result = exr_start_write(&context, name, EXR_WRITE_FILE_DIRECTLY, &options);
  if (result == EXR_ERR_SUCCESS)
    result = exr_add_part(context, "picture", EXR_STORAGE_SCANLINE, &part);
  if (result == EXR_ERR_SUCCESS)
    result = exr_initialize_required_attr_simple(context, part, (int32_t)picture->width, (int32_t)picture->height,
                                                 EXR_COMPRESSION_ZIP);
  for (int i = 0; i < 3 && result == EXR_ERR_SUCCESS; i++)
    result = exr_add_channel(context, part, channel_names[i], EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
  if (result == EXR_ERR_SUCCESS)
    result = exr_write_header(context);
  if (result == EXR_ERR_SUCCESS)
    result = write_lines(context, picture);
  const exr_result_t finished = context ? exr_finish(&context) : EXR_ERR_SUCCESS;
  if (result == EXR_ERR_SUCCESS)
    result = finished;
  if (result == EXR_ERR_SUCCESS)
    return TRAX_OK;
  free(bytes->data);
  *bytes = (struct trax_bytes){0};
  return trax_fail(error, "%s: cannot make an EXR: %s", name,
                   stream.reason[0] ? stream.reason : exr_get_default_error_message(result));
}

bool trax_is_exr(const uint8_t *bytes, size_t size) {
  static const uint8_t magic[] = {0x76, 0x2F, 0x31, 0x01};
  return size > sizeof magic && memcmp(bytes, magic, sizeof magic) == 0;
}

/* What the file is, before any of its data is unpacked. NULL: nothing is wrong. */
static const char *check_exr(exr_const_context_t context, exr_attr_box2i_t *window) {
  int parts;
  exr_storage_t storage;
  exr_compression_t compression;
  const exr_attr_chlist_t *channels;
  if (exr_get_count(context, &parts) != EXR_ERR_SUCCESS || parts != 1)
    return "it has several parts";
  if (exr_get_storage(context, 0, &storage) != EXR_ERR_SUCCESS || storage != EXR_STORAGE_SCANLINE)
    return "it is not made of scan lines";
  if (exr_get_compression(context, 0, &compression) != EXR_ERR_SUCCESS ||
      (compression != EXR_COMPRESSION_NONE && compression != EXR_COMPRESSION_RLE &&
       compression != EXR_COMPRESSION_ZIPS && compression != EXR_COMPRESSION_ZIP))
    return "it is packed by another method than RLE and ZIP";
  if (exr_get_channels(context, 0, &channels) != EXR_ERR_SUCCESS)
    return "it has no channels";
  unsigned found = 0;
  for (int i = 0; i < channels->num_channels; i++) {
    const exr_attr_chlist_entry_t *entry = &channels->entries[i];
    const int number = channel_number(entry->name.str);
    if (entry->x_sampling != 1 || entry->y_sampling != 1)
      return "a channel has fewer samples than pixels";
    if (number >= 0 && entry->pixel_type != EXR_PIXEL_UINT)
      found |= 1u << number;
  }
  if (found != 7)
    return "it has no channels R, G and B of floats";
  return exr_get_data_window(context, 0, window) == EXR_ERR_SUCCESS ? NULL : "it has no size";
}

static exr_result_t read_lines(exr_context_t context, const struct trax_picture *picture, int first_line) {
  int32_t lines;
  exr_decode_pipeline_t decoder = EXR_DECODE_PIPELINE_INITIALIZER;
  bool begun = false;
  exr_result_t result = exr_get_scanlines_per_chunk(context, 0, &lines);
  for (uint32_t y = 0; result == EXR_ERR_SUCCESS && y < picture->height; y += (uint32_t)lines) {
    exr_chunk_info_t chunk;
    result = exr_read_scanline_chunk_info(context, 0, first_line + (int)y, &chunk);
    if (result == EXR_ERR_SUCCESS)
      result = begun ? exr_decoding_update(context, 0, &chunk, &decoder)
                     : exr_decoding_initialize(context, 0, &chunk, &decoder);
    for (int i = 0; result == EXR_ERR_SUCCESS && i < decoder.channel_count; i++) {
      const int channel = channel_number(decoder.channels[i].channel_name);
      if (channel < 0)
        continue;
      decoder.channels[i].user_bytes_per_element = sizeof(float);
      decoder.channels[i].user_data_type = EXR_PIXEL_FLOAT;
      decoder.channels[i].user_pixel_stride = 3 * sizeof(float);
      decoder.channels[i].user_line_stride = 3 * (int32_t)sizeof(float) * (int32_t)picture->width;
      decoder.channels[i].decode_to_ptr = (uint8_t *)(picture->radiance + 3 * (size_t)y * picture->width + channel);
    }
    if (result == EXR_ERR_SUCCESS && !begun)
      result = exr_decoding_choose_default_routines(context, 0, &decoder);
    begun = true;
    if (result == EXR_ERR_SUCCESS)
      result = exr_decoding_run(context, 0, &decoder);
  }
  if (begun)
    exr_decoding_destroy(context, &decoder);
  return result;
}

trax_status trax_exr_decode(struct trax_picture *picture, const uint8_t *bytes, size_t size, const char *name,
                            trax_error *error) {
  struct stream stream = {.in = bytes, .size = size};
  exr_context_initializer_t options = initializer(&stream);
  exr_context_t context = NULL;
  exr_attr_box2i_t window = {0};
  options.read_fn = read_stream;
  options.size_fn = size_stream;
  *picture = (struct trax_picture){0};
  exr_result_t result = exr_start_read(&context, name, &options);
  trax_status status = TRAX_OK;
  if (result == EXR_ERR_SUCCESS) {
    const char *wrong = check_exr(context, &window);
    if (wrong)
      status = trax_fail(error, "%s: not a readable EXR: %s", name, wrong);
  }
  /* Each chunk of up to 16 lines has its place in a table and at least eight bytes of its own: nothing is allocated for
     a size that the file cannot hold. */
  const int64_t width = (int64_t)window.max.x - window.min.x + 1, height = (int64_t)window.max.y - window.min.y + 1;
  if (result == EXR_ERR_SUCCESS && status == TRAX_OK && height > 0 && (uint64_t)height > size)
    status = trax_fail(error, "%s: not a readable EXR: cut off", name);
  if (result == EXR_ERR_SUCCESS && status == TRAX_OK)
    status = allocate(picture, (uint64_t)(width > 0 ? width : 0), (uint64_t)(height > 0 ? height : 0), name, error);
  if (result == EXR_ERR_SUCCESS && status == TRAX_OK)
    result = read_lines(context, picture, window.min.y);
  if (context)
    exr_finish(&context);
  if (result != EXR_ERR_SUCCESS && status == TRAX_OK)
    status = trax_fail(error, "%s: not a readable EXR: %s", name,
                       stream.reason[0] ? stream.reason : exr_get_default_error_message(result));
  return status;
}
