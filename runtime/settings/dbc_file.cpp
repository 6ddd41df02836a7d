// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/dbc_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>

#include "runtime/settings/dbc_parser.hpp"
#include "runtime/settings/nearest_word.hpp"

namespace zonepack {
namespace {

template <typename Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  names.reserve(all.size());
  for (const Named& one : all) names.push_back(one.name);
  return names;
}

// The one of that name; when there are several, `again` is the second.
template <typename Named>
const Named* only_one(const std::vector<Named>& all, std::string_view name, const Named*& again) {
  const auto same = [name](const Named& one) { return one.name == name; };
  const auto first = std::find_if(all.begin(), all.end(), same);
  if (first == all.end()) return nullptr;
  const auto second = std::find_if(first + 1, all.end(), same);
  again = second == all.end() ? nullptr : &*second;
  return &*first;
}

std::string lines(std::uint32_t first, std::uint32_t second) {
  return "lines " + std::to_string(first) + " and " + std::to_string(second);
}

// Why these bits cannot be read from that message.
std::optional<std::string> layout_fault(const DbcMessage& message, const DbcSignal& signal) {
  const auto needed = bytes_needed(signal.bits);
  if (!needed) return "no frame holds its bits; expected 1 to 64 bits within 64 bytes";
  if (*needed > message.bytes) {
    return "its bits need " + std::to_string(*needed) + " bytes, the message has " +
           std::to_string(message.bytes);
  }
  if (signal.type == SignalType::kFloat && signal.bits.length != 32) {
    return "a float of " + std::to_string(signal.bits.length) + " bits; expected 32";
  }
  if (signal.type == SignalType::kDouble && signal.bits.length != 64) {
    return "a double of " + std::to_string(signal.bits.length) + " bits; expected 64";
  }
  if (message.id > (message.extended ? 0x1FFFFFFFu : 0x7FFu)) {
    return message.extended ? "the message's id has more than 29 bits"
                            : "the message's id has more than 11 bits; a 29-bit id has 2147483648 "
                              "(bit 31) added to it";
  }
  if (signal.factor == 0) return "its factor is 0";
  return std::nullopt;
}

// The signal whose value tells whether `signal` is there.
const DbcSignal* multiplexer_of(const DbcMessage& message, const DbcSignal& signal,
                                std::string& fault) {
  const std::vector<DbcSignal>& all = message.signals;
  if (signal.selected_by != DbcSignal::kNone) {
    return &all[static_cast<std::size_t>(signal.selected_by)];
  }
  const auto is_root = [](const DbcSignal& one) { return one.multiplexer && !one.multiplexed; };
  const auto root = std::find_if(all.begin(), all.end(), is_root);
  if (root == all.end()) {
    fault = "no signal of its message is the multiplexer (M)";
    return nullptr;
  }
  if (std::find_if(root + 1, all.end(), is_root) != all.end()) {
    fault = "its message has several multiplexers; expected SG_MUL_VAL_ to tell which one";
    return nullptr;
  }
  return &*root;
}

}  // namespace

DbcFile::DbcFile(std::string path, std::vector<DbcMessage> messages)
    : path_(std::move(path)), messages_(std::move(messages)) {}

const DbcMessage* DbcFile::find_message(std::string_view name, std::string& fault) const {
  const DbcMessage* again = nullptr;
  const DbcMessage* const message = only_one(messages_, name, again);
  if (message == nullptr) {
    fault =
        path_ + ": no message " + std::string(name) + known_words_text(name, names_of(messages_));
  } else if (again != nullptr) {
    fault = path_ + ": " + lines(message->line, again->line) + " both define a message " +
            message->name + "; expected one";
    return nullptr;
  }
  return message;
}

const DbcSignal* DbcFile::find_signal(const DbcMessage& message, std::string_view name,
                                      std::string& fault) const {
  const DbcSignal* again = nullptr;
  const DbcSignal* const signal = only_one(message.signals, name, again);
  const std::string where = path_ + ":" + std::to_string(message.line) + ": ";
  if (signal == nullptr) {
    fault = where + message.name + " has no signal " + std::string(name) +
            known_words_text(name, names_of(message.signals));
  } else if (again != nullptr) {
    fault = where + lines(signal->line, again->line) + " both define " + signal->name +
            "; expected one";
    return nullptr;
  }
  return signal;
}

// Adds the signal's multiplexers, outermost first; what is wrong, or nothing.
std::optional<std::string> DbcFile::select(const DbcMessage& message, const DbcSignal& signal,
                                           CanSignal& result) {
  struct Link {
    const DbcSignal* selected;
    const DbcSignal* by;
  };
  std::vector<Link> chain;  // innermost first
  for (const DbcSignal* one = &signal; one->multiplexed; one = chain.back().by) {
    if (chain.size() == CanSignal::kMostLevels) {
      return "more than " + std::to_string(CanSignal::kMostLevels) +
             " multiplexers above each other";
    }
    std::string fault;
    const DbcSignal* const by = multiplexer_of(message, *one, fault);
    if (by == nullptr) return fault;
    chain.push_back({one, by});
  }
  for (auto link = chain.rbegin(); link != chain.rend(); ++link) {
    if (const auto fault = layout_fault(message, *link->by)) return link->by->name + ": " + *fault;
    bool first = true;
    for (const CanSignal::Values& values : link->selected->values) {
      if (!(first ? add_multiplexer(result, link->by->bits, values) : add_values(result, values))) {
        return "more than " + std::to_string(CanSignal::Multiplexer::kMostRanges) +
               " ranges of multiplexer values";
      }
      first = false;
    }
  }
  return std::nullopt;
}

std::optional<DbcFound> DbcFile::find(std::string_view name, std::string& fault) const {
  const std::size_t dot = name.find('.');
  const DbcMessage* const message = find_message(name.substr(0, dot), fault);
  if (message == nullptr) return std::nullopt;
  if (dot == std::string_view::npos) {
    fault = path_ + ":" + std::to_string(message->line) + ": " + message->name +
            " is a message; expected MESSAGE.SIGNAL" +
            known_words_text("", names_of(message->signals));
    return std::nullopt;
  }
  const DbcSignal* const signal = find_signal(*message, name.substr(dot + 1), fault);
  if (signal == nullptr) return std::nullopt;
  DbcFound found;
  CanSignal& result = found.signal;
  result.id = message->id;
  result.extended = message->extended;
  result.bits = signal->bits;
  result.type = signal->type;
  result.factor = signal->factor;
  result.offset = signal->offset;
  std::optional<std::string> wrong = layout_fault(*message, *signal);
  if (!wrong) wrong = select(*message, *signal, result);
  if (!wrong && !is_valid(result)) wrong = "its factor or offset is not a finite number";
  if (wrong) {
    fault = path_ + ":" + std::to_string(signal->line) + ":" + std::to_string(signal->column) +
            ": " + message->name + "." + signal->name + " cannot be read: " + *wrong;
    return std::nullopt;
  }
  found.cycle_s = message->cycle_s;
  found.unit = signal->unit;
  return found;
}

LoadedDbc parse_dbc(std::string_view text, const std::string& path) {
  LoadedDbc loaded;
  if (text.size() > kLargestDbc) {
    loaded.faults = {path + ": over 4 MiB; expected a DBC file"};
    return loaded;
  }
  DbcParser parser(text, path);
  loaded.faults = std::move(parser).faults();
  // Each takes a part of its own: the faults went, the messages are still there.
  // NOLINTNEXTLINE(bugprone-use-after-move)
  if (loaded.ok()) loaded.file = DbcFile(path, std::move(parser).messages());
  return loaded;
}

LoadedDbc load_dbc(const std::string& path) {
  errno = 0;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  std::string text(kLargestDbc + 1, '\0');
  const std::size_t size = file ? std::fread(text.data(), 1, text.size(), file.get()) : 0;
  if (!file || std::ferror(file.get()) != 0) {
    LoadedDbc failed;
    failed.faults = {path + ": cannot be read: " + std::strerror(errno) + "; expected a DBC file"};
    return failed;
  }
  text.resize(size);
  LoadedDbc loaded = parse_dbc(text, path);
  loaded.text = std::move(text);
  return loaded;
}

}  // namespace zonepack
