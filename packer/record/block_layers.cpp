// SPDX-License-Identifier: Apache-2.0
#include "packer/record/block_layers.hpp"

#include <cstring>
#include <stdexcept>

#include "packer/record/append_value.hpp"

namespace zonepack::packer {
namespace {

enum class Cell : std::uint8_t { kNull, kInteger, kReal, kText, kBlob };

void put_bytes(Bytes& out, std::span<const std::byte> bytes) {
  append_value(out, static_cast<std::uint16_t>(bytes.size()));
  out.insert(out.end(), bytes.begin(), bytes.end());
}

void put_text(Bytes& out, const std::string& text) {
  put_bytes(out, std::as_bytes(std::span(text)));
}

void put_cell(Bytes& out, const TableCell& cell) {
  if (const auto* integer = std::get_if<std::int64_t>(&cell)) {
    append_value(out, Cell::kInteger);
    append_value(out, *integer);
  } else if (const auto* real = std::get_if<double>(&cell)) {
    append_value(out, Cell::kReal);
    append_value(out, *real);
  } else if (const auto* text = std::get_if<std::string>(&cell)) {
    append_value(out, Cell::kText);
    put_text(out, *text);
  } else if (const auto* blob = std::get_if<Bytes>(&cell)) {
    append_value(out, Cell::kBlob);
    put_bytes(out, *blob);
  } else {
    append_value(out, Cell::kNull);
  }
}

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  template <typename T>
  T take() {
    T value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  Bytes take_bytes() {
    const auto bytes = take(take<std::uint16_t>());
    return {bytes.begin(), bytes.end()};
  }
  std::string take_text() {
    const auto bytes = take(take<std::uint16_t>());
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  TableCell take_cell() {
    switch (take<Cell>()) {
      case Cell::kNull:
        return {};
      case Cell::kInteger:
        return take<std::int64_t>();
      case Cell::kReal:
        return take<double>();
      case Cell::kText:
        return take_text();
      case Cell::kBlob:
        return take_bytes();
    }
    fail();
  }
  bool at_end() const { return bytes_.empty(); }
  [[noreturn]] static void fail() {
    throw std::runtime_error("what it says of the layers of blocks is not whole");
  }

 private:
  std::span<const std::byte> take(std::size_t count) {
    if (bytes_.size() < count) fail();
    const auto taken = bytes_.first(count);
    bytes_ = bytes_.subspan(count);
    return taken;
  }

  std::span<const std::byte> bytes_;
};

}  // namespace

Bytes write_block_layers(const BlockLayers& layers) {
  Bytes out;
  append_value(out, layers.block_size_m);
  std::uint8_t count = 0;
  for (const auto& layer : layers.layers)
    count = static_cast<std::uint8_t>(count + layer.has_value());
  append_value(out, count);
  for (std::size_t i = 0; i < layers.layers.size(); ++i) {
    if (!layers.layers[i]) continue;
    const BlockLayerTables& tables = *layers.layers[i];
    append_value(out, static_cast<std::uint8_t>(i));
    put_text(out, tables.metadata_sql);
    put_text(out, tables.data_sql);
    const std::size_t columns = tables.metadata.empty() ? 0 : tables.metadata.front().size();
    append_value(out, static_cast<std::uint8_t>(columns));
    append_value(out, static_cast<std::uint16_t>(tables.metadata.size()));
    for (const auto& row : tables.metadata) {
      for (const TableCell& cell : row) put_cell(out, cell);
    }
  }
  return out;
}

BlockLayers read_block_layers(std::span<const std::byte> bytes) {
  Reader reader(bytes);
  BlockLayers out;
  out.block_size_m = reader.take<double>();
  if (!(out.block_size_m > 0)) Reader::fail();
  for (auto left = reader.take<std::uint8_t>(); left > 0; --left) {
    const auto layer = reader.take<std::uint8_t>();
    if (layer >= out.layers.size() || out.layers[layer]) Reader::fail();
    BlockLayerTables& tables = out.layers[layer].emplace();
    tables.metadata_sql = reader.take_text();
    tables.data_sql = reader.take_text();
    const auto columns = reader.take<std::uint8_t>();
    const auto rows = reader.take<std::uint16_t>();
    if (columns == 0 && rows > 0) Reader::fail();
    for (std::uint32_t row = 0; row < rows; ++row) {
      auto& cells = tables.metadata.emplace_back();
      for (std::uint32_t column = 0; column < columns; ++column) {
        cells.push_back(reader.take_cell());
      }
    }
  }
  if (!reader.at_end()) Reader::fail();
  return out;
}

}  // namespace zonepack::packer
