/* The scene file: what the host writes and the device traverses in place. Little endian, 32-bit fields, no pointers:
   every reference is a byte offset from the first byte of the file, so the device adds it to the address where the
   host bound the file (64-byte aligned) and nothing is relocated.

     byte   0  struct trax_scene_header, 3 lines of 64 bytes
     byte 192  the sections, each 64-byte aligned, zero bytes between them

   A file with instances has version 3, struct trax_scene_more at byte 192, and the sections behind it.

   A 64-byte line is the machine's unit of traffic, so the format minimises the lines per ray. A BVH node holds both
   children's boxes and is one line. A leaf's triangles are contiguous, 40 bytes each, with their material, in the order
   in which a depth-first traversal meets the leaves, so that neighbouring leaves share lines.
   The section table is indexed by kind. A section that a program does not read may be absent: offset, count and
   size 0.

   References (trax_scene_ref): nodes are 64-byte and triangles 8-byte aligned, which leaves the low three bits for the
   number of triangles:
     0                nothing: only as the root of a scene without triangles
     offset | 0       an inner node at that offset
     offset | 1..7    a leaf: so many triangles, the first at that offset
   In the tree over instances (struct trax_instance) a leaf is offset | 1, and the offset is an instance's.
   Included by C for the TP, C for the host, and C++. */
#ifndef TRAX_SCENE_FORMAT_H
#define TRAX_SCENE_FORMAT_H

#include <stdint.h>

#define TRAX_SCENE_MAGIC 0x53585254u /* the bytes "TRXS" */
#define TRAX_SCENE_VERSION 2u
#define TRAX_SCENE_VERSION_INSTANCES 3u
#define TRAX_SCENE_ALIGNMENT 64u
#define TRAX_SCENE_MAX_LEAF 7u       /* limit of the triangles in a leaf */
#define TRAX_SCENE_MAX_DEPTH 62u     /* limit of the inner nodes from the root to a leaf */
#define TRAX_SCENE_DEFAULT_DEPTH 32u /* the builder's: a stack for as many is in the device's memory as a whole */

typedef uint32_t trax_scene_ref;
#define TRAX_SCENE_REF_COUNT(ref) ((ref) & 7u)   /* triangles of a leaf; 0: an inner node */
#define TRAX_SCENE_REF_OFFSET(ref) ((ref) & ~7u) /* bytes from the start of the file */

#define TRAX_NODE_MOST_CHILDREN 8u

/* The grid of quantised nodes: along each axis 2^16 planes at equal distances. The first plane is at bounds_min, and
   all triangles are below the last but one. trax_scene_grid_of (scene.h) computes the grid. */
#define TRAX_GRID_LAST 65535u

enum trax_scene_section_kind {
  TRAX_SCENE_NODES = 0,      /* as header.node_layout says, the root first, otherwise in any order */
  TRAX_SCENE_TRIANGLES = 1,  /* struct trax_triangle, in the order of a depth-first traversal, without gaps */
  TRAX_SCENE_MATERIALS = 2,  /* struct trax_material; at least one if there are triangles */
  TRAX_SCENE_SOURCE_IDS = 3, /* uint32_t per triangle: its number in the imported mesh; for the host only */
  /* struct trax_triangle_normals of each triangle, for smooth shading, right behind the triangles. */
  TRAX_SCENE_NORMALS = 4,
  /* struct trax_triangle_uvs of each triangle, right behind the normals, or the triangles if there are none. */
  TRAX_SCENE_UVS = 5,
  TRAX_SCENE_TEXTURES = 6, /* struct trax_texture; only with UVs */
  TRAX_SCENE_TEXELS = 7,   /* uint32_t, of all textures, one behind the other */
  TRAX_SCENE_SECTIONS = 8  /* slots in the table */
};

struct trax_scene_section {
  uint32_t offset;      /* bytes from the start of the file, a multiple of 64; 0: absent */
  uint32_t size;        /* bytes: count * record_size */
  uint32_t count;       /* records */
  uint32_t record_size; /* bytes */
};

struct trax_scene_header {
  uint32_t magic;          /* TRAX_SCENE_MAGIC */
  uint32_t version;        /* TRAX_SCENE_VERSION, or TRAX_SCENE_VERSION_INSTANCES */
  uint32_t file_size;      /* bytes, header included, a multiple of 64 */
  uint32_t checksum;       /* CRC-32 (ISO 3309, as in zlib) of the whole file with this field zero */
  trax_scene_ref root;     /* an inner node; a leaf if that holds all triangles; 0 if there are none */
  uint32_t max_depth;      /* most inner nodes on a path from the root. A traversal that pushes the other child of each
                              never has more entries on its stack. In layouts of four children: most entries of one
                              that pushes all children of a node but one */
  uint32_t max_leaf;       /* most triangles in one leaf */
  uint32_t triangle_count; /* = sections[TRAX_SCENE_TRIANGLES].count */
  float bounds_min[3];     /* of all triangles, or of all instances' boxes; zeros if there are none */
  float bounds_max[3];
  uint32_t base; /* 0: references are offsets, as in every file. Otherwise they are addresses in the device's memory,
                    which has the scene at this one (render/device_scene.c) */
  uint32_t node_layout; /* layouts/records.h */
  struct trax_scene_section sections[TRAX_SCENE_SECTIONS];
};

/* --- instances: triangles once, at many places --- */

/* Nodes are binary. First come those of the tree over the instances, one fewer than there are instances; header.root is
   its root. Then come those of each mesh. header.max_depth is the depth of the deepest instance with that of its mesh
   and one: a traversal marks on its stack where it left the upper tree. */
enum trax_scene_more_kind {
  TRAX_SCENE_INSTANCES = 0,     /* struct trax_instance, in the order of a depth-first traversal */
  TRAX_SCENE_MESHES = 1,        /* struct trax_scene_mesh; for the host only */
  TRAX_SCENE_MORE_SECTIONS = 4, /* the others are zero */
};

struct trax_scene_more {
  struct trax_scene_section sections[TRAX_SCENE_MORE_SECTIONS];
};

#define TRAX_NO_MATERIAL UINT32_MAX

/* The point p of the mesh is at origin + to_world p. The first line is what a traversal reads. to_object, stretch,
   spread and flags follow from the rest (scene/placing.c). */
struct trax_instance {
  float to_object[3][3]; /* the inverse of to_world, rounded once: a ray from o along d is a ray from to_object (o -
                            origin) along to_object d in the mesh, and distances are the same */
  float origin[3];
  trax_scene_ref root; /* of the mesh's tree */
  float stretch;       /* the margin of boxes in the mesh is this times that of the scene's */
  uint32_t material;   /* of all triangles; TRAX_NO_MATERIAL: their own */
  uint32_t flags;      /* TRAX_INSTANCE_MIRRORED */
  float to_world[3][3];
  float spread; /* the error of a surface's place is this times its distance from `origin`; 0: the transform has
                   no error */
  uint32_t first_number; /* the triangles of the instances before it in the file */
  uint32_t first_source; /* its triangles' numbers in the mesh begin here when all are flattened */
  uint32_t mesh;
  uint32_t reserved[3]; /* zero */
};

#define TRAX_INSTANCE_MIRRORED 0x80000000u /* to_world turns v0, v1, v2 counterclockwise into clockwise */

struct trax_scene_mesh {
  trax_scene_ref root;
  uint32_t first_triangle, triangle_count; /* of the section of triangles; the meshes follow one another */
  uint32_t source_count;                   /* of the triangles as imported, with those that were dropped */
  uint32_t depth;                          /* most inner nodes from the root to a leaf */
  float bounds_min[3], bounds_max[3];
  uint32_t reserved[5]; /* zero */
};

struct trax_triangle {
  float v0[3], v1[3], v2[3]; /* finite; winding as in the mesh */
  uint32_t material;         /* index into the materials */
};

/* The record is as large as a triangle, so the distance from a triangle to its normals is constant. */
struct trax_triangle_normals {
  float corner[3][3]; /* of length 1, on the side of v0, v1, v2 counterclockwise */
  uint32_t reserved;  /* zero */
};

/* Texture coordinates, also as long as a triangle. u runs along a texture's rows, v across them. */
struct trax_triangle_uvs {
  float corner[3][2];   /* of magnitude TRAX_SCENE_MAX_UV at most */
  uint32_t reserved[4]; /* zero */
};

#define TRAX_SCENE_MAX_UV 8192.0f /* leaves ten bits of a texel's place in its texture */

enum trax_material_kind {
  TRAX_MATERIAL_LAMBERT = 0,
  TRAX_MATERIAL_MIRROR = 1, /* reflects `specular` */
  TRAX_MATERIAL_GLASS = 2,  /* smooth, of index `ior`; transmits `specular` of the light */
  TRAX_MATERIAL_GGX = 3,    /* a rough layer that reflects `specular` at normal incidence, over Lambert's `diffuse` */
  TRAX_MATERIAL_KINDS = 4
};

/* Colours are linear RGB. Members that a kind does not read have the values of trax_default_material. */
struct trax_material {
  float diffuse[3];   /* reflectance, 0 to 1; multiplied by the texture */
  uint32_t kind;      /* enum trax_material_kind */
  float specular[3];  /* 0 to 1 */
  float roughness;    /* alpha of GGX, 0 to 1 */
  float emission[3];  /* radiance, 0 to TRAX_SCENE_MAX_EMISSION */
  float ior;          /* index of refraction against air, 1 to TRAX_SCENE_MAX_IOR */
  float opacity;      /* 0 to 1; multiplied by the texture's alpha */
  float alpha_cutoff; /* smaller opacity is a hole; 0: no holes */
  uint32_t texture;   /* index into the textures + 1; 0: none */
  uint32_t reserved;  /* zero */
};

#define TRAX_SCENE_MAX_EMISSION 1e6f
#define TRAX_SCENE_MAX_IOR 16.0f

enum { TRAX_TEXTURE_ALPHA = 1, TRAX_TEXTURE_CLAMP = 2 /* else repeated */ };

/* 2^log2_height rows, the one at v = 0 first, each of 2^log2_width texels, that at u = 0 first; the texel (i, j) covers
   u from i / width to (i + 1) / width. Texels have R, G, B, A from their lowest byte; R, G and B are 255 *
   sqrt(linear), as in the picture, A is 255 * opacity. */
struct trax_texture {
  uint32_t texels;                  /* bytes from the start of the file */
  uint32_t log2_width, log2_height; /* at most TRAX_TEXTURE_MAX_LOG2 */
  uint32_t flags;                   /* TRAX_TEXTURE_... */
};

#define TRAX_TEXTURE_MAX_LOG2 12u

#ifdef __cplusplus
#define TRAX_SCENE_ASSERT_SIZE(type, bytes) static_assert(sizeof(type) == (bytes), #type " has no padding")
#else
#define TRAX_SCENE_ASSERT_SIZE(type, bytes) _Static_assert(sizeof(type) == (bytes), #type " has no padding")
#endif
TRAX_SCENE_ASSERT_SIZE(struct trax_scene_section, 16);
TRAX_SCENE_ASSERT_SIZE(struct trax_scene_header, 192);
TRAX_SCENE_ASSERT_SIZE(struct trax_scene_more, 64);
TRAX_SCENE_ASSERT_SIZE(struct trax_instance, 128);
TRAX_SCENE_ASSERT_SIZE(struct trax_scene_mesh, 64);
TRAX_SCENE_ASSERT_SIZE(struct trax_triangle, 40);
TRAX_SCENE_ASSERT_SIZE(struct trax_triangle_normals, sizeof(struct trax_triangle));
TRAX_SCENE_ASSERT_SIZE(struct trax_triangle_uvs, sizeof(struct trax_triangle));
TRAX_SCENE_ASSERT_SIZE(struct trax_material, 64);
TRAX_SCENE_ASSERT_SIZE(struct trax_texture, 16);
#undef TRAX_SCENE_ASSERT_SIZE

#endif
