/* SPDX-License-Identifier: Apache-2.0 */
#include <stdio.h>
#include <zonepack/client.h>

int main(int argc, char** argv) {
  zp_status status = ZP_OK;
  if (argc != 2 || zp_connect(argv[1], "c_only", 500, &status) != NULL) return 2;
  printf("status %d\n", (int)status);
  return 0;
}
