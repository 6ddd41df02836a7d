/* SPDX-License-Identifier: Apache-2.0 */
#include "tests/unit/runtime/client/c_reader.h"

#include <string.h>

static void add_feature(const zp_feature* feature, void* user) {
  c_totals* const totals = user;
  totals->sum_of_words += feature->word_id;
  totals->sum_of_x += (double)feature->x_px;
  totals->descriptor_bytes += feature->descriptor_bytes;
}

static void add_link(const zp_link* link, void* user) {
  (void)link;
  ((c_totals*)user)->links++;
}

static void add_point(const float* numbers, uint32_t count, void* user) {
  (void)numbers;
  ((c_totals*)user)->scan_points += count > 0;
}

static void add_cell(const float* numbers, uint32_t count, void* user) {
  (void)numbers;
  ((c_totals*)user)->cells += count > 1;
}

static void ignore(const uint8_t* bytes, size_t count, void* user) {
  (void)bytes, (void)count, (void)user;
}

static void add_zone(const zp_zone* zone, void* user) {
  c_totals* const totals = user;
  totals->signatures = zp_signature_count(zone);
  for (uint32_t i = 0; i < totals->signatures; ++i) {
    zp_signature signature;
    if (!zp_get_signature(zone, i, &signature)) return;
    totals->sum_of_ids += signature.id;
    totals->label_bytes += signature.label_bytes;
    totals->features += zp_features(zone, i, add_feature, totals);
    (void)zp_links(zone, i, add_link, totals);
    (void)zp_points(zone, i, ZP_SCAN_POINTS, add_point, totals);
    (void)zp_points(zone, i, ZP_GROUND, add_cell, totals);
    (void)zp_points(zone, i, ZP_OBSTACLES, add_cell, totals);
    (void)zp_points(zone, i, ZP_EMPTY, add_cell, totals);
    totals->image_bytes += zp_blob(zone, i, ZP_IMAGE, ignore, totals);
  }
}

zp_status c_read_zone(zp_client* client, uint32_t zone, c_totals* totals) {
  memset(totals, 0, sizeof *totals);
  return zp_read(client, zone, add_zone, totals);
}
