// SPDX-License-Identifier: Apache-2.0
// Manifests with a correct digest whose claims the packs contradict.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <sstream>

#include "packer/verify/map_verifier.hpp"
#include "tests/support/small_map.hpp"

namespace zonepack::packer {
namespace {

using test_support::SmallMap;

std::string listed(const Problems& problems) {
  std::string text;
  for (const Problem& problem : problems) text += to_string(problem) + "\n";
  return text;
}

struct Lie {
  const char* name;
  std::function<void(SmallMap&)> falsify;
  const char* found;  // part of the message
};

void PrintTo(const Lie& lie, std::ostream* out) { *out << lie.name; }

class LyingManifest : public testing::TestWithParam<Lie> {};

TEST_P(LyingManifest, IsFound) {
  SmallMap map;
  GetParam().falsify(map);
  map.write_manifest();
  const Verdict verdict = verify_map(map.folder);
  EXPECT_THAT(listed(verdict.problems), testing::HasSubstr(GetParam().found));
}

void move_node(SmallMap& map, float dx, float dy, float dz, float dyaw) {
  fb::Node& n = map.content.nodes[0][0];
  n = fb::Node(n.x() + dx, n.y() + dy, n.z() + dz, n.yaw() + dyaw, n.id());
}

INSTANTIATE_TEST_SUITE_P(
    OfAZone, LyingManifest,
    testing::Values(
        Lie{"Features",
            [](SmallMap& m) {
              ++m.packs[0].features, m.content.source_feature_count += 9,
                  m.content.source_bytes += 9 * 72;
            },
            "zone a: the manifest says features 4, the pack has 3"},
        Lie{"Signatures",
            [](SmallMap& m) {
              ++m.packs[0].signatures;
              m.content.nodes[0].emplace_back(1.0F, 1.0F, 0.0F, 0.0F, 9);
            },
            "says signatures 2, the pack has 1"},
        Lie{"PackBytes", [](SmallMap& m) { --m.packs[0].bytes; }, "says pack_bytes"},
        Lie{"PackDigest", [](SmallMap& m) { m.packs[0].digest[31] ^= 1; }, "says digest"},
        Lie{"PackOfAnotherZone",
            [](SmallMap& m) {
              std::swap(m.packs[0].file, m.packs[1].file);
              std::swap(m.packs[0].digest, m.packs[1].digest);
            },
            "names a pack of zone 'a', the pack is of zone 'b'"},
        Lie{"PackThatIsNotThere", [](SmallMap& m) { m.packs[0].file[3] ^= 1; },
            "the file is not there"},
        Lie{"PackNotCalledByItsContent",
            [](SmallMap& m) {
              m.folder.files["a-0000000000000000.zpk"] = m.folder.files[m.packs[0].file];
              m.packs[0].file = "a-0000000000000000.zpk";
            },
            "by its content it is"},
        Lie{"GridNeedsScan",
            [](SmallMap& m) { m.packs[0].grid_needs_scan = !m.packs[0].grid_needs_scan; },
            "says grid_needs_scan"},
        Lie{"DecodedBytes", [](SmallMap& m) { ++m.packs[0].payloads[1].decoded; },
            "says decoded bytes of features"},
        Lie{"StoredBytes", [](SmallMap& m) { ++m.packs[0].payloads[2].stored; },
            "says stored bytes of scan"},
        Lie{"Chunks", [](SmallMap& m) { ++m.packs[0].payloads[3].chunks; }, "says chunks of grid"},
        Lie{"PayloadLeftOut", [](SmallMap& m) { m.packs[0].payloads[4] = {}; },
            "does not list payload image"},
        Lie{"SlotsOfOneSet", [](SmallMap& m) { ++m.packs[0].slots[63]; },
            "says slots of payload set 127"},
        Lie{"SlotsOfTheCore", [](SmallMap& m) { --m.packs[0].slots[0]; },
            "says slots of payload set 1 0, the pack has 1"},
        Lie{"Parent", [](SmallMap& m) { m.plan.zones[0].parent = "hall"; },
            "parts are called 'hall.1'"},
        Lie{"NodeId",
            [](SmallMap& m) {
              const fb::Node& n = m.content.nodes[0][0];
              m.content.nodes[0][0] = fb::Node(n.x(), n.y(), n.z(), n.yaw(), 3);
            },
            "says node number 0 is 3, the pack has 1"},
        Lie{"NodeX", [](SmallMap& m) { move_node(m, 0.001F, 0, 0, 0); }, "places node 1 elsewhere"},
        Lie{"NodeY", [](SmallMap& m) { move_node(m, 0, 0.001F, 0, 0); }, "places node 1 elsewhere"},
        Lie{"NodeZ", [](SmallMap& m) { move_node(m, 0, 0, 0.001F, 0); }, "places node 1 elsewhere"},
        Lie{"NodeYaw", [](SmallMap& m) { move_node(m, 0, 0, 0, 0.001F); },
            "places node 1 elsewhere"}),
    [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(
    OfTheMap, LyingManifest,
    testing::Values(
        Lie{"PolygonMovedAway",
            [](SmallMap& m) {
              // Room a shrinks to x 0 to 1, room b grows over signature 1 at x = 2.
              m.plan.zones[0].polygon.outer = {{0, 0}, {1, 0}, {1, 4}, {0, 4}};
              m.plan.zones[1].polygon.outer = {{1, 0}, {8, 0}, {8, 4}, {1, 4}};
              m.plan.portals[0].segment = {{1, 1.5}, {1, 2.5}};
            },
            "signature 1 is in the pack of zone a, by the polygons it belongs to zone b"},
        Lie{"HoleAroundTheSignature",
            [](SmallMap& m) {
              m.plan.zones[0].polygon.outer = {{0, 0}, {8, 0}, {8, 4}, {0, 4}};
              m.plan.zones[0].polygon.holes = {{{5, 1}, {5, 3}, {5.5, 3}, {5.5, 1}}};
              m.plan.zones[1].polygon.outer = {{4, 0}, {5, 0}, {5, 4}, {4, 4}};
            },
            "signature 2 is in the pack of zone b"},
        Lie{"Heights",
            [](SmallMap& m) {
              m.plan.zones[0].z_min_m = 10;
              m.plan.zones[1].polygon.outer = {{0, 0}, {8, 0}, {8, 4}, {0, 4}};
              m.plan.portals.clear();
            },
            "signature 1 is in the pack of zone a"},
        Lie{"PortalOffTheBorder",
            [](SmallMap& m) {
              m.plan.portals[0].segment.p = {3, 1.5};
            },
            "portal 'a-b' ends 1.0"},
        Lie{"EdgeCount", [](SmallMap& m) { m.content.edges[0] = fb::ZoneEdge(0, 1, 3); },
            "says 3 links between zones a and b, the packs hold 2"},
        Lie{"EdgeLeftOut", [](SmallMap& m) { m.content.edges.clear(); },
            "leaves out 2 links between zones a and b"},
        Lie{"EdgeTwice", [](SmallMap& m) { m.content.edges.push_back(m.content.edges[0]); },
            "the packs hold 0"},
        Lie{"PayloadMask",
            [](SmallMap& m) {
              m.content.payload = kDefaultPayload & ~mask_of(fb::PayloadKind::Blocks);
              for (PackSummary& pack : m.packs) pack.slots.resize(8);
            },
            "has payload image, which the map's mask leaves out"},
        Lie{"FeaturesOfTheSource", [](SmallMap& m) { m.content.source_feature_count = 5; },
            "says the source had 5 features, the packs hold 6"},
        Lie{"BytesOfTheSource", [](SmallMap& m) { m.content.source_bytes = 6 * 72 - 1; },
            "fewer than its features alone take"}),
    [](const auto& test) { return test.param.name; });

// A version that an update made: zones that it named are as of change 1.
VersionChange version_change(std::vector<std::string> added, std::vector<std::string> changed,
                             std::vector<std::string> drawn, std::vector<std::string> replaced,
                             std::uint32_t zones_before = 2) {
  VersionChange out;
  out.what = "add";
  out.zones = zones_before;
  out.added = std::move(added);
  out.changed = std::move(changed);
  out.drawn = std::move(drawn);
  out.replaced = std::move(replaced);
  return out;
}

// Room a ends at x 1, so that signature 1 at x 2 stands in b.
void give_signature_1_to_b(SmallMap& m) {
  m.plan.zones[0].polygon.outer = {{0, 0}, {1, 0}, {1, 4}, {0, 4}};
  m.plan.zones[1].polygon.outer = {{1, 0}, {8, 0}, {8, 4}, {1, 4}};
  m.plan.portals[0].segment = {{1, 1.5}, {1, 2.5}};
}

// Room a reaches to x 7, so that signature 2 at x 6 stands in it and not in b.
void give_signature_2_to_a(SmallMap& m) {
  m.plan.zones[0].polygon.outer = {{0, 0}, {7, 0}, {7, 4}, {0, 4}};
  m.plan.zones[1].polygon.outer = {{7, 0}, {8, 0}, {8, 4}, {7, 4}};
  m.plan.portals[0].segment = {{7, 1.5}, {7, 2.5}};
}

TEST(UpdatedManifests, MayHaveDrawnAZoneAroundASignatureOfOneThatStays) {
  SmallMap added;
  give_signature_1_to_b(added);
  added.content.changes = {version_change({"b"}, {}, {}, {}, 1)};
  added.write_manifest();
  EXPECT_TRUE(verify_map(added.folder).whole()) << listed(verify_map(added.folder).problems);
  SmallMap redrawn;
  give_signature_1_to_b(redrawn);
  redrawn.content.changes = {version_change({}, {"b"}, {"b"}, {"b"})};
  redrawn.write_manifest();
  EXPECT_TRUE(verify_map(redrawn.folder).whole()) << listed(verify_map(redrawn.folder).problems);
}

INSTANTIATE_TEST_SUITE_P(
    OfAnUpdate, LyingManifest,
    testing::Values(
        Lie{"SignatureOfANewZoneThatStandsInAnOldOne",
            [](SmallMap& m) {
              give_signature_2_to_a(m);
              m.content.changes = {version_change({"b"}, {}, {}, {}, 1)};
            },
            "signature 2 is in the pack of zone b, by the polygons it belongs to zone a"},
        Lie{"SignatureOfAChangedZoneThatWasNotDrawn",
            [](SmallMap& m) {
              give_signature_1_to_b(m);
              m.content.changes = {version_change({}, {"b"}, {}, {})};
            },
            "signature 1 is in the pack of zone a, by the polygons it belongs to zone b"},
        Lie{"SignatureThatCameAfterTheOtherZoneWasDrawn",
            [](SmallMap& m) {
              give_signature_1_to_b(m);
              m.content.changes = {version_change({}, {"b"}, {"b"}, {"b"}),
                                   version_change({}, {"a"}, {}, {"a"})};
            },
            "signature 1 is in the pack of zone a, by the polygons it belongs to zone b"},
        Lie{"AddedZoneThatIsNotThere",
            [](SmallMap& m) { m.content.changes = {version_change({"c"}, {}, {}, {}, 1)}; },
            "says in change number 1 that zone c was added, and then has none of that name"},
        Lie{"RemovedZoneThatIsThere",
            [](SmallMap& m) {
              m.content.changes = {version_change({}, {}, {}, {}, 2)};
              m.content.changes[0].removed = {"a"};
            },
            "that zone a was removed, and then has one of that name"},
        Lie{"ZonesBefore",
            [](SmallMap& m) { m.content.changes = {version_change({"b"}, {}, {}, {}, 2)}; },
            "says in change number 1 there were 2 zones before it, by its lists 1"},
        Lie{"AddedAndChanged",
            [](SmallMap& m) { m.content.changes = {version_change({"b"}, {"b"}, {}, {}, 1)}; },
            "that zone b was there before, and was added"},
        Lie{"OutOfOrder",
            [](SmallMap& m) {
              m.content.changes = {version_change({}, {"b", "a"}, {}, {})};
            },
            "that zones were changed out of order or twice"},
        Lie{"AddedTwice",
            [](SmallMap& m) {
              m.content.changes = {version_change({"b"}, {}, {}, {}, 1),
                                   version_change({"b"}, {}, {}, {}, 1)};
            },
            "says in change number 1 that zone b was added, and then has none of that name"}),
    [](const auto& test) { return test.param.name; });

// Every claim of the manifest that a pack or another part of the manifest can contradict. Left out:
// what is in the manifest only (lineage, labels, types, which portals there are, texts of the
// provenance) and coordinates, which are compared with signatures and borders with some tolerance.
std::string claims(const fb::Manifest& manifest) {
  std::ostringstream out;
  out << manifest.frame()->str() << manifest.slot_bytes() << ' ' << manifest.payload_mask();
  for (const fb::Zone* zone : *manifest.zones()) {
    out << "\n"
        << zone->name()->str() << ' ' << zone->signatures() << ' ' << zone->features() << ' '
        << zone->pack()->str() << ' ' << zone->pack_bytes() << ' '
        << to_hex(std::span(zone->pack_digest()->data(), zone->pack_digest()->size())) << ' '
        << zone->grid_needs_scan() << ' ' << (zone->parent() == nullptr);
    for (const fb::PayloadBytes* p : *zone->payloads()) {
      out << ' ' << int{p->kind()} << ':' << p->chunks() << ':' << p->stored() << ':'
          << p->decoded();
    }
    for (const std::uint32_t slots : *zone->slots()) out << ' ' << slots;
    for (const fb::Node* node : *zone->nodes()) {
      out << ' ' << node->id() << ' ' << node->x() << ' ' << node->y() << ' ' << node->z();
    }
  }
  for (const fb::ZoneEdge* edge : *manifest.edges()) {
    out << "\n" << edge->zone_a() << ' ' << edge->zone_b() << ' ' << edge->links();
  }
  return out.str();
}

TEST(LyingManifests, WithAnyBitChangedUnderARightDigestAreFoundOrClaimTheSame) {
  SmallMap map;
  Bytes& file = map.folder.files[std::string(kManifestName)];
  const std::string truth = claims(**check_manifest(file));
  const std::size_t end = file.size() - sizeof(ManifestTail);
  std::size_t found = 0;
  for (std::size_t bit = sizeof(ManifestHeader) * 8; bit < end * 8; ++bit) {
    const auto mask = static_cast<std::byte>(1u << (bit % 8));
    file[bit / 8] ^= mask;
    test_support::seal_manifest(file);
    if (!verify_map(map.folder).whole()) {
      ++found;
    } else {
      EXPECT_EQ(claims(**check_manifest(file)), truth) << "byte " << bit / 8 << " bit " << bit % 8;
    }
    file[bit / 8] ^= mask;
  }
  EXPECT_GT(found, (end - sizeof(ManifestHeader)) * 8 / 2);
}

TEST(LyingManifests, ThatAreMissingLeaveThePacksToBeCheckedByThemselves) {
  SmallMap map;
  map.folder.files.erase(std::string(kManifestName));
  map.folder.files[map.packs[1].file].back() ^= std::byte{1};
  const Verdict verdict = verify_map(map.folder);
  EXPECT_EQ(verdict.packs, 2u);
  ASSERT_EQ(verdict.problems.size(), 2u) << listed(verdict.problems);
  EXPECT_EQ(verdict.problems[0].place.file, kManifestName);
  EXPECT_EQ(verdict.problems[1].place.file, map.packs[1].file);
}

TEST(LyingManifests, DoNotMakeOtherFilesInTheFolderAProblem) {
  SmallMap map;
  map.folder.files["c-0123456789abcdef.zpk"] = Bytes(10);
  map.folder.files["pack.zpk.part-77-0"] = Bytes(10);
  map.folder.files["notes.txt"] = Bytes(10);
  const Verdict verdict = verify_map(map.folder);
  EXPECT_TRUE(verdict.whole()) << listed(verdict.problems);
  EXPECT_THAT(verdict.unnamed,
              testing::ElementsAre("c-0123456789abcdef.zpk", "pack.zpk.part-77-0"));
}

TEST(LyingManifests, WithOneSignatureInTwoZonesAreFound) {
  test_support::SignatureRecipe one;
  one.x = 4;  // on the border: both could hold it
  one.y = 2;
  SmallMap map({one}, {one});
  EXPECT_THAT(listed(verify_map(map.folder).problems),
              testing::HasSubstr("signature 1 is in zone a and in zone b"));
}

}  // namespace
}  // namespace zonepack::packer
