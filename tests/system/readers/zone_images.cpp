// SPDX-License-Identifier: Apache-2.0
#include "tests/system/readers/zone_images.hpp"

#include <bit>

#include "packer/encode/pack_writer.hpp"
#include "tests/support/shared_zones.hpp"
#include "tests/support/signature_recipe.hpp"
#include "tests/support/temporary_folder.hpp"

namespace zonepack::test_support {
namespace {

constexpr std::int32_t kIdsPerImage = 100;

// Images differ in how many signatures, features and points they have, hence in every offset.
DecodedPack make_image(std::int32_t image) {
  const TemporaryFolder folder;
  packer::PackWriter writer(folder.path(), "zone");
  for (std::int32_t i = 0; i < 2 + image % 4; ++i) {
    SignatureRecipe recipe;
    recipe.id = image * kIdsPerImage + i + 1;
    recipe.x = static_cast<float>(image);
    recipe.features = static_cast<std::size_t>(60 + 13 * image);
    recipe.scan_points = 150 + 31 * image;
    recipe.user_data = image % 2 == 0;
    recipe.neighbours = {recipe.id + 1};
    packer::SignatureRecord record = make_signature(recipe);
    writer.add(record, recipe.x, recipe.y);
  }
  const auto reader = PackReader::open(folder / writer.finish(kEveryPayload).file);
  return DecodedPack::decode(*reader, kEveryPayload).value();
}

// FNV-1a over words and bytes.
class Digest {
 public:
  void add(std::uint64_t word) { state_ = (state_ ^ word) * 0x100000001B3ull; }
  void add(float value) { add(std::uint64_t{std::bit_cast<std::uint32_t>(value)}); }
  void add(ByteSpan bytes) {
    add(std::uint64_t{bytes.size()});
    for (const std::byte byte : bytes) add(std::to_integer<std::uint64_t>(byte));
  }
  void add(const TableRows& rows) {
    add(std::uint64_t{rows.size()});
    rows.for_each([this](ByteSpan row) { add(row); });
  }
  std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0xCBF29CE484222325ull;
};

void add(const SignatureView& s, Digest& digest) {
  digest.add(static_cast<std::uint64_t>(s.id()));
  if (const auto T = s.T_map_base()) {
    for (const float value : *T) digest.add(value);
  }
  s.for_each_link([&](const LinkView& link) { digest.add(static_cast<std::uint64_t>(link.to)); });
  s.features().for_each([&](const Feature& f) {
    for (const float value :
         {f.x_px, f.y_px, f.size_px, f.angle, f.response, f.p_base[0], f.p_base[1], f.p_base[2]}) {
      digest.add(value);
    }
    digest.add(static_cast<std::uint64_t>(f.octave));
    digest.add(static_cast<std::uint64_t>(f.word_id));
    digest.add(f.descriptor);
  });
  if (const auto scan = s.scan()) {
    digest.add(scan->range_max_m);
    digest.add(scan->points);
  }
  if (const auto grid = s.grid()) {
    digest.add(grid->cell_m);
    for (const TableRows& cells : {grid->ground, grid->obstacles, grid->empty}) digest.add(cells);
  }
  digest.add(s.rows(fb::Part::Image));
  digest.add(s.rows(fb::Part::UserData));
}

}  // namespace

std::uint64_t digest_of(const ZoneSignatures& signatures) {
  Digest digest;
  for (std::uint32_t i = 0; i < signatures.size(); ++i) add(signatures[i], digest);
  return digest.value();
}

ZoneImages::ZoneImages(std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) {
    packs_.push_back(make_image(static_cast<std::int32_t>(i)));
    slots_.push_back(SharedZones::slots_for(packs_.back().chunks()));
    digests_.push_back(digest_of(ZoneSignatures(packs_.back().view())));
  }
}

std::uint32_t ZoneImages::recognise(const ZoneSignatures& signatures) const {
  if (signatures.size() == 0) return size();
  const auto image = static_cast<std::uint32_t>(signatures[0].id() / kIdsPerImage);
  return image < size() && digest_of(signatures) == digests_[image] ? image : size();
}

}  // namespace zonepack::test_support
