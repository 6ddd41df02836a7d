// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstdio>
#include <memory>

#include "platform/files/atomic_file.hpp"
#include "platform/process/run_program.hpp"
#include "runtime/report/report.hpp"

namespace zonepack::report {
namespace {

constexpr const char* kInstead = "or write the report as .svg or .html instead";

Outcome<void> write_text(const std::string& path, const std::string& text) {
  const Result<void> written = write_file_atomically(path, text);
  if (!written) return cannot_write(path, written.error());
  return {};
}

Outcome<void> write_png(const std::string& path, const std::string& svg) {
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
    return failure(
        path + ": drawing PNG needs the program rsvg-convert: install the package librsvg2-bin, " +
            kInstead,
        ErrorCode::kNotFound);
  }
  if (!status) return cannot_write(path, status.error());
  if (*status != 0) {
    return failure(path + ": rsvg-convert failed with status " + std::to_string(*status) +
                       "; see its message above, " + kInstead,
                   ErrorCode::kIo);
  }
  const Result<void> written = png->commit();
  if (!written) return cannot_write(path, written.error());
  return {};
}

}  // namespace

Outcome<void> check_report_name(const std::string& path) {
  for (const char* kind : {".html", ".svg", ".png"}) {
    if (path.ends_with(kind)) return {};
  }
  return usage_failure(path +
                       ": a report is written as .html, .svg or .png; the name ends in none of "
                       "them");
}

Outcome<void> write_report(const std::string& path, const Report& report) {
  if (path.ends_with(".html")) return write_text(path, to_html(report));
  if (path.ends_with(".svg")) return write_text(path, to_sheet(report).file_text());
  if (path.ends_with(".png")) return write_png(path, to_sheet(report).file_text());
  return check_report_name(path);
}

}  // namespace zonepack::report
