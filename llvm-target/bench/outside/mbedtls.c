#include "outside.h"
#include <mbedtls/aes.h>
#include <mbedtls/chacha20.h>
#include <mbedtls/md5.h>
#include <mbedtls/sha1.h>
#include <mbedtls/sha256.h>
#include <mbedtls/sha512.h>

enum { SIZE = 16384 };
static unsigned char text[SIZE], output[SIZE];

void kernel_setup(void) {
  outside_begin();
  outside_text((char *)text, SIZE);
}

struct result kernel_run(void) {
  unsigned char key[32], vector[16] = {0}, hash[64];
  memcpy(key, text, sizeof key);
  mbedtls_aes_context aes;
  mbedtls_aes_init(&aes);
  mbedtls_aes_setkey_enc(&aes, key, 128);
  mbedtls_aes_crypt_cbc(&aes, MBEDTLS_AES_ENCRYPT, SIZE, vector, text, output);
  uint32_t sum = outside_sum(output, SIZE);
  mbedtls_chacha20_crypt(key, vector, 0, SIZE, text, output);
  sum = mix(sum, outside_sum(output, SIZE));
  mbedtls_sha256_ret(text, SIZE, hash, 0);
  sum = mix(sum, outside_sum(hash, 32));
  mbedtls_sha512_ret(text, SIZE, hash, 0);
  sum = mix(sum, outside_sum(hash, 64));
  mbedtls_sha1_ret(text, SIZE, hash);
  sum = mix(sum, outside_sum(hash, 20));
  mbedtls_md5_ret(text, SIZE, hash);
  return (struct result){mix(sum, outside_sum(hash, 16)), 0};
}
