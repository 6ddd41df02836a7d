/* SPDX-License-Identifier: Apache-2.0 */
/* The map in zoned's memory, for programs in C and languages that can call C. The same as
 * client.hpp, whose comments say more.
 *
 * Reading: zp_read() calls your function, which reads the zone's signatures in place. What it read
 * is valid only if zp_read() then returns ZP_OK; with ZP_EXPIRED the zone was unloaded meanwhile,
 * and what it read may be anything (but never outside the bounds). Pointers passed to your function
 * are valid until it returns. An index that is too large gives 0 or nothing.
 *
 * Threads: one at a time per client.
 * Units: metres, radians, seconds; see FORMAT.md for frames. */
#ifndef ZONEPACK_CLIENT_H
#define ZONEPACK_CLIENT_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct zp_client zp_client;
typedef struct zp_zone zp_zone;

typedef enum {
  ZP_OK = 0,
  ZP_EXPIRED = 1,   /* unloaded while it was read: discard what was read; read again */
  ZP_ABSENT = 2,    /* not loaded, or no such zone */
  ZP_DAMAGED = 3,   /* not written by a working zoned */
  ZP_NO_SERVER = 4, /* no zoned at that socket, or it is gone: close and connect again */
  ZP_BUSY = 5,      /* no answer in time, or cannot be done now: try again */
  ZP_REFUSED = 6    /* zoned refuses: not allowed, no room, another version or map */
} zp_status;

/* ---- the connection ---- */

/* NULL when there is none, with the reason in *status (which may be NULL). */
zp_client* zp_connect(const char* socket_path, const char* program_name, int timeout_ms,
                      zp_status* status);
/* Without a socket: memory laid out by zoned that stays mapped for as long as the client exists. */
zp_client* zp_open_memory(const void* memory, size_t bytes, zp_status* status);
void zp_close(zp_client* client);

/* ZP_ABSENT for a name that the map does not have. */
zp_status zp_find_zone(zp_client* client, const char* name, uint32_t* zone);
uint32_t zp_zone_count(const zp_client* client);

typedef struct {
  uint32_t zone, generation, epoch;
  int64_t lasts_ns;
} zp_lease;
zp_status zp_take_lease(zp_client* client, uint32_t zone, zp_lease* lease);
zp_status zp_release(zp_client* client, const zp_lease* lease);

/* Where the robot was at stamp_ns of CLOCK_MONOTONIC; covariance xx xy xyaw yy yyaw yawyaw. */
zp_status zp_give_pose(zp_client* client, double x, double y, double yaw,
                       const double covariance[6], int64_t stamp_ns);

/* ---- reading a zone ---- */

zp_status zp_read(zp_client* client, uint32_t zone, void (*fn)(const zp_zone* zone, void* user),
                  void* user);

typedef struct {
  int32_t id, map_id, weight;
  double stamp_s;
  const char* label; /* not terminated */
  size_t label_bytes;
  int has_pose, has_odometry_pose;
  float T_map_base[12], T_odom_base[12]; /* row-major 3x4 */
  uint32_t features, links;
  const uint8_t* calibration; /* as the source stored it */
  size_t calibration_bytes;
} zp_signature;

uint32_t zp_signature_count(const zp_zone* zone);
/* 1 when there is one, else 0. */
int zp_get_signature(const zp_zone* zone, uint32_t index, zp_signature* signature);

typedef struct {
  float x_px, y_px, size_px, angle, response;
  int32_t octave, word_id;
  float p_base[3];           /* NaN where unknown */
  const uint8_t* descriptor; /* in place; NULL: none */
  size_t descriptor_bytes;
} zp_feature;

/* Calls fn for each feature of a signature, in order; returns how many. */
uint32_t zp_features(const zp_zone* zone, uint32_t index,
                     void (*fn)(const zp_feature* feature, void* user), void* user);

typedef struct {
  int32_t to, type;
  int has_transform;
  float T_from_to[12];
  const double* information; /* 36, row-major; NULL: none */
} zp_link;
uint32_t zp_links(const zp_zone* zone, uint32_t index, void (*fn)(const zp_link* link, void* user),
                  void* user);

typedef struct {
  int32_t format;
  float range_min_m, range_max_m, angle_min, angle_max, angle_increment, max_points;
  float T_base_scan[12];
  uint32_t points;
} zp_scan;
int zp_get_scan(const zp_zone* zone, uint32_t index, zp_scan* scan);

typedef struct {
  float cell_m;
  float view_point[3];
  uint32_t ground, obstacles, empty; /* cells */
} zp_grid;
int zp_get_grid(const zp_zone* zone, uint32_t index, zp_grid* grid);

typedef enum { ZP_SCAN_POINTS, ZP_GROUND, ZP_OBSTACLES, ZP_EMPTY } zp_points_kind;
/* Calls fn with the numbers of each point or cell (x, y, then what the source has), in order;
 * returns how many. */
uint32_t zp_points(const zp_zone* zone, uint32_t index, zp_points_kind kind,
                   void (*fn)(const float* numbers, uint32_t count, void* user), void* user);

typedef enum { ZP_IMAGE, ZP_DEPTH } zp_blob_kind;
/* Calls fn with the bytes of an image as the source stored it, piece by piece; returns their sum.
 */
size_t zp_blob(const zp_zone* zone, uint32_t index, zp_blob_kind kind,
               void (*fn)(const uint8_t* bytes, size_t count, void* user), void* user);

/* ---- blocks of voxels (maps of nvblox) ---- */

typedef struct {
  int32_t x, y, z; /* its lower corner is index x block size, in the map frame */
  uint32_t layers; /* bit 0 TSDF, 1 colour, 2 occupancy, 3 ESDF */
} zp_block;

typedef enum { ZP_TSDF, ZP_COLOR, ZP_OCCUPANCY, ZP_ESDF } zp_layer;

/* Metres; 0 when the zone holds no blocks. */
double zp_block_size(const zp_zone* zone);
uint32_t zp_block_count(const zp_zone* zone);
/* 1 when there is one, else 0. Any order that stays while the zone is loaded. */
int zp_get_block(const zp_zone* zone, uint32_t index, zp_block* block);
/* By position, in a constant number of steps; 1 when the zone has it, else 0. */
int zp_find_block(const zp_zone* zone, int32_t x, int32_t y, int32_t z, zp_block* block);
/* Copies 512 voxels [x][y][z], z fastest, as nvblox has them: TSDF {float distance, weight}, colour
 * {uint8 r, g, b, a; float weight}, occupancy {float log odds}, ESDF {float squared distance; int32
 * parent[3]; uint8 inside, observed, site, 0}. `bytes` must be what they take: 4096, 4096, 2048,
 * 10240. 1 when it was copied, else 0. */
int zp_copy_block(const zp_zone* zone, int32_t x, int32_t y, int32_t z, zp_layer layer, void* out,
                  size_t bytes);

#ifdef __cplusplus
}
#endif

#endif /* ZONEPACK_CLIENT_H */
