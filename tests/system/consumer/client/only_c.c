/* SPDX-License-Identifier: Apache-2.0 */
#include <zonepack/client.h>

/* The header is enough in C. */
zp_status read_nothing(zp_client* client);
zp_status read_nothing(zp_client* client) { return zp_read(client, 0, NULL, NULL); }
