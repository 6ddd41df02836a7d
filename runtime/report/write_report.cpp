// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "platform/atomic_file.hpp"
#include "platform/run_program.hpp"
#include "runtime/report/report.hpp"

namespace zonepack::report {
namespace {

constexpr const char* kInstead = "or write the report as .svg or .html instead";

std::string cannot_write(const std::string& path, Error error) {
  return path + ": cannot write the report: " +
         (error.code == ErrorCode::kIo ? std::strerror(static_cast<int>(error.detail))
                                       : to_string(error.code));
}

std::optional<std::string> write_text(const std::string& path, const std::string& text) {
  const Result<void> written = write_file_atomically(path, text);
  return written ? std::nullopt : std::optional(cannot_write(path, written.error()));
}

std::optional<std::string> write_png(const std::string& path, const std::string& svg) {
  Result<AtomicFile> png = AtomicFile::create(path);
  if (!png) return cannot_write(path, png.error());
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> input(std::tmpfile(), &std::fclose);
  if (!input || std::fwrite(svg.data(), 1, svg.size(), input.get()) != svg.size() ||
      std::fflush(input.get()) != 0) {
    return cannot_write(path, {ErrorCode::kIo, errno});
  }
  std::rewind(input.get());
  const Result<int> status = run_program({"rsvg-convert", "--format", "png", "--zoom", "2"},
                                         fileno(input.get()), png->descriptor());
  if (!status && status.error().code == ErrorCode::kNotFound) {
    return path +
           ": drawing PNG needs the program rsvg-convert: install the package librsvg2-bin, " +
           kInstead;
  }
  if (!status) return cannot_write(path, status.error());
  if (*status != 0) {
    return path + ": rsvg-convert failed with status " + std::to_string(*status) +
           "; see its message above, " + kInstead;
  }
  const Result<void> written = png->commit();
  return written ? std::nullopt : std::optional(cannot_write(path, written.error()));
}

}  // namespace

std::optional<std::string> fault_of_report_name(const std::string& path) {
  for (const char* kind : {".html", ".svg", ".png"}) {
    if (path.ends_with(kind)) return std::nullopt;
  }
  return path + ": a report is written as .html, .svg or .png; the name ends in none of them";
}

std::optional<std::string> write_report(const std::string& path, const Report& report) {
  if (path.ends_with(".html")) return write_text(path, to_html(report));
  if (path.ends_with(".svg")) return write_text(path, to_sheet(report).file_text());
  if (path.ends_with(".png")) return write_png(path, to_sheet(report).file_text());
  return fault_of_report_name(path);
}

}  // namespace zonepack::report
