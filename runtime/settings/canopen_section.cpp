// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/canopen_section.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <string_view>

#include "runtime/settings/field.hpp"

namespace zonepack {
namespace {

struct MappedObject {
  std::uint32_t index = 0;
  std::uint32_t sub_index = 0;
  std::uint32_t bits = 0;
};

// "0x60640020": index 6064, sub-index 00, 32 bits.
bool parse_object(std::string_view text, MappedObject& object) {
  if (!text.starts_with("0x") && !text.starts_with("0X")) return false;
  text.remove_prefix(2);
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (error != std::errc() || end != text.data() + text.size() || text.size() != 8) return false;
  object = {value >> 16, value >> 8 & 0xFF, value & 0xFF};
  return object.bits >= 1 && object.bits <= 64;
}

// By CiA 402 and CiA 301; vendors' own objects are mostly signed.
bool is_unsigned(std::uint32_t index) {
  constexpr std::array<std::uint32_t, 7> kUnsigned = {0x1001, 0x603F, 0x6040, 0x6041,
                                                      0x6079, 0x60FD, 0x60FE};
  return std::find(kUnsigned.begin(), kUnsigned.end(), index) != kUnsigned.end();
}

std::string object_name(const std::string& node, const MappedObject& object) {
  std::array<char, 32> text{};
  if (object.sub_index == 0) {
    std::snprintf(text.data(), text.size(), ".%04X", object.index);
  } else {
    std::snprintf(text.data(), text.size(), ".%04Xsub%X", object.index, object.sub_index);
  }
  return node + text.data();
}

struct Pdo {
  const char* key;
  const std::vector<std::string>& objects;
  std::uint32_t id;
};

void add_signals(const YamlSection& section, const std::string& node, const Pdo& pdo,
                 std::map<std::string, CanSignal>& signals, FaultList& faults) {
  constexpr std::uint32_t kLastDummy = 0x0007;  // objects 1 to 7 fill gaps
  std::uint32_t start = 0;
  const auto add_fault = [&](const std::string& text) {
    faults.add(section.mark_of(pdo.key), section.path_of(pdo.key), text);
  };
  for (const std::string& text : pdo.objects) {
    MappedObject object;
    if (!parse_object(text, object)) {
      add_fault("\"" + text +
                "\" is not a mapped object; allowed: 0x, 4 digits of index, 2 of sub-index, 2 of "
                "length in bits: 0x60640020");
      return;
    }
    if (start + object.bits > 64) {
      add_fault("more than 64 bits with " + text + "; a frame holds 8 bytes");
      return;
    }
    CanSignal signal;
    signal.id = pdo.id;
    signal.bits = {static_cast<std::uint16_t>(start), static_cast<std::uint16_t>(object.bits),
                   ByteOrder::kLittle};
    signal.type = is_unsigned(object.index) ? SignalType::kUnsigned : SignalType::kSigned;
    start += object.bits;
    if (object.index <= kLastDummy) continue;
    if (!signals.emplace(object_name(node, object), signal).second) {
      add_fault("there are two signals " + object_name(node, object) + "; expected one");
    }
  }
}

void read_node(const std::string& name, const YAML::Node& yaml, CanSettings& can,
               FaultList& faults) {
  YamlSection section(yaml, "can.canopen.nodes." + name, faults);
  CanOpenNodeText text;
  section.read(canopen_node_fields(), text);
  section.finish();
  if (text.node == 0) {
    if (!section.has("node")) {
      faults.add(section.mark(), section.path_of("node"), "missing; allowed: 1 to 127");
    }
    return;
  }
  const auto id = [&](std::uint32_t given, std::uint32_t base) {
    return given != 0 ? given : base + text.node;
  };
  for (const Pdo& pdo : {Pdo{"tpdo1", text.tpdo1, id(text.tpdo1_id, 0x180)},
                         Pdo{"tpdo2", text.tpdo2, id(text.tpdo2_id, 0x280)},
                         Pdo{"tpdo3", text.tpdo3, id(text.tpdo3_id, 0x380)},
                         Pdo{"tpdo4", text.tpdo4, id(text.tpdo4_id, 0x480)}}) {
    add_signals(section, name, pdo, can.signals, faults);
  }
  if (!text.heartbeat) return;
  CanOpenWatchSettings& watch = can.canopen;
  if (watch.node_count == watch.nodes.size()) {
    faults.add(section.mark(), section.path_of("heartbeat"),
               "at most " + std::to_string(watch.nodes.size()) +
                   " nodes are watched; heartbeat: false leaves one out");
    return;
  }
  watch.nodes[watch.node_count++] = static_cast<std::uint8_t>(text.node);
}

}  // namespace

void read_canopen(YamlSection& can_section, CanSettings& can, FaultList& faults) {
  const YAML::Node yaml = can_section.take("canopen");
  if (!yaml.IsDefined()) return;
  YamlSection section(yaml, "can.canopen", faults);
  section.read(canopen_fields(), can.canopen);
  const YamlSection nodes(section.take("nodes"), "can.canopen.nodes", faults);
  for (const auto& [name, node] : nodes.entries()) read_node(name, node, can, faults);
  section.finish();
}

}  // namespace zonepack
