// SPDX-License-Identifier: Apache-2.0
// What `zonepack build --payload features,scan,grid` cannot avoid: reading the rows of a database,
// unzipping their blobs, and LZ4 HC 9 over what came out, in blocks of 64 KiB. Nothing is parsed,
// encoded, checked or written.
//
//   read_unzip_compress DB [THREADS]
#include <lz4.h>
#include <lz4hc.h>
#include <sqlite3.h>
#include <zlib.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

constexpr std::size_t kBlock = 65536;

class Statement {
 public:
  Statement(sqlite3* database, const std::string& sql) {
    if (sqlite3_prepare_v2(database, sql.c_str(), -1, &row_, nullptr) != SQLITE_OK) {
      throw std::runtime_error(sql + ": " + sqlite3_errmsg(database));
    }
  }
  ~Statement() { sqlite3_finalize(row_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  template <typename Fn>
  void run(std::int64_t id, Fn&& fn) {
    sqlite3_reset(row_);
    sqlite3_bind_int64(row_, 1, id);
    while (sqlite3_step(row_) == SQLITE_ROW) fn(row_);
  }

 private:
  sqlite3_stmt* row_ = nullptr;
};

sqlite3* open(const std::string& path) {
  sqlite3* database = nullptr;
  const std::string uri = "file:" + path + "?immutable=1";
  if (sqlite3_open_v2(uri.c_str(), &database,
                      SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX,
                      nullptr) != SQLITE_OK) {
    throw std::runtime_error(path + ": cannot be opened");
  }
  return database;
}

struct Sums {
  std::uint64_t read = 0, unzipped = 0, compressed = 0;
};

class Worker {
 public:
  explicit Worker(const std::string& path) : database_(open(path)) {}
  ~Worker() { sqlite3_close(database_); }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  Sums run(const std::vector<std::int64_t>& ids, std::atomic<std::size_t>& next) {
    Statement node(database_, "SELECT pose, ground_truth_pose FROM Node WHERE id = ?1");
    Statement data(database_,
                   "SELECT calibration, scan_info, scan, ground_cells, obstacle_cells, empty_cells "
                   "FROM Data WHERE id = ?1");
    Statement link(database_, "SELECT transform, information_matrix FROM Link WHERE from_id = ?1");
    Statement feature(database_,
                      "SELECT pos_x, pos_y, size, dir, response, depth_x, depth_y, depth_z, "
                      "word_id, octave, descriptor FROM Feature WHERE node_id = ?1");
    constexpr std::size_t kBatch = 16;
    for (std::size_t begin; (begin = next.fetch_add(kBatch)) < ids.size();) {
      for (std::size_t i = begin; i < std::min(begin + kBatch, ids.size()); ++i) {
        node.run(ids[i], [&](auto* row) { take_blobs(row, 0, 2); });
        link.run(ids[i], [&](auto* row) { take_blobs(row, 0, 2); });
        data.run(ids[i], [&](auto* row) {
          take_blobs(row, 0, 2);
          for (int column = 2; column < 6; ++column) unzip(row, column);
        });
        feature.run(ids[i], [&](auto* row) {
          for (int column = 0; column < 8; ++column) {
            const auto value = static_cast<float>(sqlite3_column_double(row, column));
            append(&value, sizeof value);
          }
          for (int column = 8; column < 10; ++column) {
            const std::int32_t value = sqlite3_column_int(row, column);
            append(&value, sizeof value);
          }
          take_blobs(row, 10, 11);
        });
      }
    }
    compress(block_.size());
    return sums_;
  }

 private:
  void append(const void* data, std::size_t size) {
    const auto* const bytes = static_cast<const char*>(data);
    block_.insert(block_.end(), bytes, bytes + size);
    while (block_.size() >= kBlock) compress(kBlock);
  }

  void take_blobs(sqlite3_stmt* row, int begin, int end) {
    for (int column = begin; column < end; ++column) {
      const void* const data = sqlite3_column_blob(row, column);
      if (data == nullptr) continue;
      const auto size = static_cast<std::size_t>(sqlite3_column_bytes(row, column));
      sums_.read += size;
      append(data, size);
    }
  }

  void unzip(sqlite3_stmt* row, int column) {
    const auto* const data = static_cast<const Bytef*>(sqlite3_column_blob(row, column));
    if (data == nullptr) return;
    const auto size = static_cast<std::size_t>(sqlite3_column_bytes(row, column));
    sums_.read += size;
    std::int32_t shape[3];
    std::memcpy(shape, data + size - sizeof shape, sizeof shape);
    const auto elements = static_cast<std::size_t>(shape[0]) * static_cast<std::size_t>(shape[1]);
    matrix_.resize(elements * static_cast<std::size_t>((shape[2] >> 3) + 1) * 8);
    uLongf written = matrix_.size();
    if (uncompress(matrix_.data(), &written, data, size) != Z_OK) {
      throw std::runtime_error("a blob does not unzip");
    }
    sums_.unzipped += written;
    append(matrix_.data(), written);
  }

  void compress(std::size_t size) {
    if (size == 0) return;
    compressed_.resize(static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(size))));
    sums_.compressed += static_cast<std::uint64_t>(
        LZ4_compress_HC(block_.data(), compressed_.data(), static_cast<int>(size),
                        static_cast<int>(compressed_.size()), 9));
    block_.erase(block_.begin(), block_.begin() + static_cast<std::ptrdiff_t>(size));
  }

  sqlite3* database_;
  std::vector<char> block_, compressed_;
  std::vector<Bytef> matrix_;
  Sums sums_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "usage: read_unzip_compress DB [THREADS]\n";
    return 2;
  }
  const std::string path = argv[1];
  const int threads = argc > 2 ? std::max(1, std::atoi(argv[2])) : 2;
  try {
    const auto begin = std::chrono::steady_clock::now();
    std::vector<std::int64_t> ids;
    sqlite3* const database = open(path);
    Statement(database, "SELECT id FROM Node WHERE weight > -9 AND ?1 = ?1 ORDER BY id")
        .run(0, [&](auto* row) { ids.push_back(sqlite3_column_int64(row, 0)); });
    sqlite3_close(database);
    std::atomic<std::size_t> next = 0;
    std::vector<Sums> sums(static_cast<std::size_t>(threads));
    {
      std::vector<std::jthread> workers;
      for (Sums& own : sums) {
        workers.emplace_back([&] { own = Worker(path).run(ids, next); });
      }
    }
    Sums all;
    for (const Sums& own : sums) {
      all.read += own.read;
      all.unzipped += own.unzipped;
      all.compressed += own.compressed;
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    std::cout << ids.size() << " signatures on " << threads << " threads: " << took.count()
              << " s; blobs " << all.read << " bytes, unzipped " << all.unzipped << ", after HC 9 "
              << all.compressed << "\n";
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
