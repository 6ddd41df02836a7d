// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/dbc_file.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <memory>
#include <utility>

#include "platform/base/file_kind.hpp"
#include "platform/base/nearest_word.hpp"
#include "runtime/settings/dbc_parser.hpp"

namespace zonepack {
namespace {

template <typename Named>
std::vector<std::string> names_of(const std::vector<Named>& all) {
  std::vector<std::string> names;
  names.reserve(all.size());
  for (const Named& one : all) names.push_back(one.long_name.empty() ? one.name : one.long_name);
  return names;
}

// The first of that name, or null; `again` is the second of that name, or null.
template <typename Named>
const Named* only_one(const std::vector<Named>& all, std::string_view name, const Named*& again) {
  const bool by_long_name = std::any_of(all.begin(), all.end(),
                                        [name](const Named& one) { return one.long_name == name; });
  const auto same = [&](const Named& one) {
    return (by_long_name ? one.long_name : one.name) == name;
  };
  const auto first = std::find_if(all.begin(), all.end(), same);
  if (first == all.end()) return nullptr;
  const auto second = std::find_if(first + 1, all.end(), same);
  again = second == all.end() ? nullptr : &*second;
  return &*first;
}

// "0x123" or "291".
bool is_id(std::string_view text, std::uint32_t id) {
  const bool hex = text.starts_with("0x") || text.starts_with("0X");
  if (hex) text.remove_prefix(2);
  std::uint32_t value = 0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value, hex ? 16 : 10);
  return error == std::errc() && end == text.data() + text.size() && value == id;
}

std::string lines(std::uint32_t first, std::uint32_t second) {
  return "lines " + std::to_string(first) + " and " + std::to_string(second);
}

// The checks from here to find() fail with what is wrong with a signal; find() adds which one and
// where it stands.
Outcome<void> check_layout(const DbcMessage& message, const DbcSignal& signal) {
  const auto needed = bytes_needed(signal.bits);
  if (!needed) return failure("no frame holds its bits; expected 1 to 64 bits within 64 bytes");
  if (*needed > message.bytes) {
    return failure("its bits need " + std::to_string(*needed) + " bytes, the message has " +
                   std::to_string(message.bytes));
  }
  if (signal.type == SignalType::kFloat && signal.bits.length != 32) {
    return failure("a float of " + std::to_string(signal.bits.length) + " bits; expected 32");
  }
  if (signal.type == SignalType::kDouble && signal.bits.length != 64) {
    return failure("a double of " + std::to_string(signal.bits.length) + " bits; expected 64");
  }
  if (message.id > (message.extended ? 0x1FFFFFFFu : 0x7FFu)) {
    return failure(message.extended ? "the message's id has more than 29 bits"
                                    : "the message's id has more than 11 bits; a 29-bit id has "
                                      "2147483648 (bit 31) added to it");
  }
  if (signal.factor == 0) return failure("its factor is 0");
  return {};
}

// The signal whose value says whether `signal` is present. Never null.
Outcome<const DbcSignal*> multiplexer_of(const DbcMessage& message, const DbcSignal& signal) {
  const std::vector<DbcSignal>& all = message.signals;
  if (signal.selected_by != DbcSignal::kNone) {
    return &all[static_cast<std::size_t>(signal.selected_by)];
  }
  const auto is_root = [](const DbcSignal& one) { return one.multiplexer && !one.multiplexed; };
  const auto root = std::find_if(all.begin(), all.end(), is_root);
  if (root == all.end()) return failure("no signal of its message is the multiplexer (M)");
  if (std::find_if(root + 1, all.end(), is_root) != all.end()) {
    return failure("its message has several multiplexers; expected SG_MUL_VAL_ to say which one");
  }
  return &*root;
}

// Adds the signal's multiplexers to `result`, outermost first.
Outcome<void> add_multiplexers(const DbcMessage& message, const DbcSignal& signal,
                               CanSignal& result) {
  struct Link {
    const DbcSignal* selected;
    const DbcSignal* by;
  };
  std::vector<Link> chain;  // innermost first
  for (const DbcSignal* one = &signal; one->multiplexed; one = chain.back().by) {
    if (chain.size() == CanSignal::kMostLevels) {
      return failure("more than " + std::to_string(CanSignal::kMostLevels) +
                     " multiplexers above each other");
    }
    const auto by = multiplexer_of(message, *one);
    if (!by) return by.error();
    chain.push_back({one, *by});
  }
  for (auto link = chain.rbegin(); link != chain.rend(); ++link) {
    if (const auto fits = check_layout(message, *link->by); !fits) {
      return failure(link->by->name + ": " + fits.error().message);
    }
    if (link->selected->values.empty()) {
      return failure("its multiplexer mark m has no number, so nothing says when it is present");
    }
    if (!link->by->slip.empty()) return failure("its multiplexer: " + link->by->slip);
    bool first = true;
    for (const CanSignal::Values& values : link->selected->values) {
      if (!(first ? add_multiplexer(result, link->by->bits, values) : add_values(result, values))) {
        return failure("more than " + std::to_string(CanSignal::Multiplexer::kMostRanges) +
                       " ranges of multiplexer values");
      }
      first = false;
    }
  }
  return {};
}

Outcome<CanSignal> to_can_signal(const DbcMessage& message, const DbcSignal& signal) {
  if (!signal.slip.empty()) return failure(signal.slip);
  CanSignal result;
  result.id = message.id;
  result.extended = message.extended;
  result.bits = signal.bits;
  result.type = signal.type;
  result.factor = signal.factor;
  result.offset = signal.offset;
  if (const auto fits = check_layout(message, signal); !fits) return fits.error();
  if (const auto added = add_multiplexers(message, signal, result); !added) return added.error();
  if (!is_valid(result)) return failure("its factor or offset is not a finite number");
  return result;
}

}  // namespace

DbcFile::DbcFile(std::string path, std::vector<DbcMessage> messages)
    : path_(std::move(path)), messages_(std::move(messages)) {}

Outcome<const DbcMessage*> DbcFile::find_message(std::string_view full,
                                                 std::string_view signal) const {
  const std::size_t at = full.find('@');
  const std::string_view name = full.substr(0, at);
  std::vector<const DbcMessage*> named;
  for (const DbcMessage& one : messages_) {
    if (one.name != name && one.long_name != name) continue;
    if (at == full.npos || is_id(full.substr(at + 1), one.id)) named.push_back(&one);
  }
  if (named.empty()) {
    return failure(
        path_ + ": no message " + std::string(full) + known_words_text(name, names_of(messages_)),
        ErrorCode::kNotFound);
  }
  if (named.size() == 1) return named.front();
  std::vector<const DbcMessage*> holding;
  for (const DbcMessage* const one : named) {
    const DbcSignal* again = nullptr;
    if (only_one(one->signals, signal, again) != nullptr) holding.push_back(one);
  }
  if (holding.size() == 1) return holding.front();
  return failure(path_ + ": " + lines(named[0]->line, named[1]->line) + " both define a message " +
                 std::string(name) + "; say which one by its id: " + std::string(name) + "@" +
                 std::to_string(named[0]->id) + "." + std::string(signal));
}

Outcome<const DbcSignal*> DbcFile::find_signal(const DbcMessage& message,
                                               std::string_view name) const {
  const DbcSignal* again = nullptr;
  const DbcSignal* const signal = only_one(message.signals, name, again);
  const std::string where = path_ + ":" + std::to_string(message.line) + ": ";
  if (signal == nullptr) {
    return failure(where + message.name + " has no signal " + std::string(name) +
                       known_words_text(name, names_of(message.signals)),
                   ErrorCode::kNotFound);
  }
  if (again != nullptr) {
    return failure(where + lines(signal->line, again->line) + " both define " + signal->name +
                   "; expected one");
  }
  return signal;
}

Outcome<DbcFound> DbcFile::find(std::string_view name) const {
  const std::size_t dot = name.find('.');
  const auto message =
      find_message(name.substr(0, dot), dot == name.npos ? "" : name.substr(dot + 1));
  if (!message) return message.error();
  const DbcMessage& in = **message;
  if (dot == std::string_view::npos) {
    return failure(path_ + ":" + std::to_string(in.line) + ": " + in.name +
                   " is a message; expected MESSAGE.SIGNAL" +
                   known_words_text("", names_of(in.signals)));
  }
  const auto signal = find_signal(in, name.substr(dot + 1));
  if (!signal) return signal.error();
  const DbcSignal& wanted = **signal;
  const auto readable = to_can_signal(in, wanted);
  if (!readable) {
    return failure(path_ + ":" + std::to_string(wanted.line) + ":" + std::to_string(wanted.column) +
                   ": " + in.name + "." + wanted.name +
                   " cannot be read: " + readable.error().message);
  }
  return DbcFound{.signal = *readable, .cycle_s = in.cycle_s, .unit = wanted.unit};
}

LoadedDbc parse_dbc(std::string_view text, const std::string& path) {
  LoadedDbc loaded;
  if (text.size() > kLargestDbc) {
    loaded.faults = {path + ": over 4 MiB; expected a DBC file"};
    return loaded;
  }
  DbcParser parser(text, path);
  DbcSlips found = std::move(parser).slips();
  // Each takes a part of its own: the slips went, the messages are still there.
  // NOLINTNEXTLINE(bugprone-use-after-move)
  std::vector<DbcMessage> messages = std::move(parser).messages();
  loaded.faults = std::move(found.faults);
  loaded.slips = std::move(found.slips);
  // Text that is no DBC file at all.
  if (messages.empty() && loaded.ok()) std::swap(loaded.faults, loaded.slips);
  if (loaded.ok()) loaded.file = DbcFile(path, std::move(messages));
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
  if (const std::string kind = stand_in(text, path); !kind.empty()) {
    LoadedDbc failed;
    failed.faults = {path + ": is " + kind + "; expected a DBC file"};
    return failed;
  }
  LoadedDbc loaded = parse_dbc(text, path);
  loaded.text = std::move(text);
  return loaded;
}

}  // namespace zonepack
