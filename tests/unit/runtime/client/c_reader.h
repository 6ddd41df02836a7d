/* SPDX-License-Identifier: Apache-2.0 */
/* A program in C that reads a zone, for c_api_test.cpp. */
#ifndef C_READER_H
#define C_READER_H

#include "runtime/client/zonepack_client.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
  uint32_t signatures, features, links, scan_points, cells;
  size_t image_bytes, descriptor_bytes, label_bytes;
  int64_t sum_of_ids, sum_of_words;
  double sum_of_x;
} c_totals;

zp_status c_read_zone(zp_client* client, uint32_t zone, c_totals* totals);

#ifdef __cplusplus
}
#endif

#endif
