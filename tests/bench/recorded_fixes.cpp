// SPDX-License-Identifier: Apache-2.0
// Prints the fixes that a live run was given, from its recording: stamp (s), x, y (m), yaw (rad).
// tenant.sh judges them by the truth, which zoneloc does not have while it drives.
//
//   recorded_fixes RECORDING
#include <cstdio>

#include "runtime/recording/recording_reader.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: recorded_fixes RECORDING\n"), 2;
  auto recording = zonepack::RecordingReader::open(argv[1]);
  if (!recording) {
    return std::fprintf(stderr, "recorded_fixes: %s\n", recording.error().message.c_str()), 1;
  }
  while (const zonepack::RecordedInput* const input = recording->next()) {
    for (const zonepack::PoseCorrection& fix : input->corrections) {
      std::printf("%.6f %.6f %.6f %.6f\n", static_cast<double>(fix.stamp_ns) * 1e-9,
                  fix.T_map_base.x_m, fix.T_map_base.y_m, fix.T_map_base.yaw_rad);
    }
  }
  return 0;
}
