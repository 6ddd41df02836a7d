// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/dbc_parser.hpp"

#include <algorithm>
#include <charconv>
#include <utility>

namespace zonepack {
namespace {

constexpr std::uint64_t kExtendedFlag = 0x80000000;
constexpr std::uint64_t kNoFrame = 0xC0000000;  // VECTOR__INDEPENDENT_SIG_MSG: signals of no frame
constexpr std::string_view kCycleTime = "GenMsgCycleTime";
constexpr std::string_view kLongSignal = "SystemSignalLongSymbol";  // of names over 32 characters
constexpr std::string_view kLongMessage = "SystemMessageLongSymbol";

}  // namespace

DbcParser::DbcParser(std::string_view text, std::string path) : in_(text, std::move(path)) {
  while (!in_.ended()) statement();
  apply_cycle_times();
  apply_long_names();
}

// A slip costs its statement, unless the statement may change how any signal is read.
void DbcParser::statement() {
  const std::size_t before = in_.slips();
  read_statement();
  if (in_.slips() == before) return;
  if (in_.begin().is("SIG_VALTYPE_") || in_.begin().is("SG_MUL_VAL_")) in_.condemn();
}

void DbcParser::read_statement() {
  if (!in_.begin_statement()) return;
  const auto is = [this](std::string_view word) { return in_.begin().is(word); };
  if (is("VERSION")) {
    std::string_view ignored;
    in_.text(ignored, "the version, a text in quotes");
  } else if (is("NS_")) {
    symbols();
  } else if (is("BS_")) {
    bit_timing();
  } else if (is("BU_")) {
    nodes();
  } else if (is("BO_")) {
    message();
  } else if (is("SG_")) {
    signal();
  } else if (is("SIG_VALTYPE_")) {
    value_type();
  } else if (is("SG_MUL_VAL_")) {
    multiplex_values();
  } else if (is("BA_")) {
    attribute();
  } else if (is("BA_DEF_DEF_")) {
    attribute_default();
  } else {
    in_.skip_statement();
  }
}

// NS_ : CM_ BA_DEF_ ... has no terminator, and the words it lists begin statements elsewhere. A
// symbol is alone on its line or followed by another symbol.
void DbcParser::symbols() {
  if (!in_.sign(':')) return;
  while (in_.at_symbol()) in_.advance();
}

// BS_: [rate : btr1 , btr2]
void DbcParser::bit_timing() {
  if (!in_.sign(':')) return;
  while (in_.now().kind == DbcToken::Kind::kNumber || in_.now().is_sign(':') ||
         in_.now().is_sign(','))
    in_.advance();
  if (in_.now().is_sign(';')) in_.advance();
}

void DbcParser::nodes() {
  if (!in_.sign(':')) return;
  while (in_.now().kind != DbcToken::Kind::kEnd && in_.now().kind != DbcToken::Kind::kText &&
         !in_.at_statement())
    in_.advance();
}

// BO_ id name: bytes sender
void DbcParser::message() {
  DbcMessage message;
  message.line = in_.begin().line;
  std::uint64_t id = 0;
  std::uint64_t bytes = 0;
  std::string_view name;
  ignored_ = true;  // until the message is understood
  if (!in_.whole(id, 0xFFFFFFFF, "the message's id, a whole number up to 4294967295") ||
      !in_.word(name, "the message's name") || !in_.sign(':') ||
      !in_.whole(bytes, 0xFFFF, "the message's length in bytes")) {
    return;
  }
  // The sender is not needed.
  if (in_.at_statement() || in_.now().kind != DbcToken::Kind::kWord) {
    in_.add_slip(in_.now(), "the sender's name (Vector__XXX: none)");
  } else {
    in_.advance();
  }
  if (id == kNoFrame) return;
  ignored_ = false;
  message.name = name;
  message.extended = (id & kExtendedFlag) != 0;
  message.id = static_cast<std::uint32_t>(id & ~kExtendedFlag);
  message.bytes = static_cast<std::uint32_t>(bytes);
  by_id_.emplace(id, messages_.size());
  messages_.push_back(std::move(message));
}

// SG_ name [M|m1|m1M] : start|length@order sign (factor,offset) [least|most] "unit" receivers
void DbcParser::signal() {
  DbcSignal signal;
  signal.line = in_.begin().line;
  signal.column = in_.begin().column;
  const bool read = signal_head(signal) && signal_layout(signal) && signal_scale(signal);
  if (read) receivers();
  if (ignored_ || signal.name.empty()) return;
  if (!read) signal.slip = in_.newest_slip();
  if (messages_.empty()) {
    in_.add_slip(in_.begin(), "a message (BO_) before its signals");
    return;
  }
  if (++signals_ > kMostDbcSignals) {
    in_.add_fault(in_.begin(), "at most " + std::to_string(kMostDbcSignals) + " signals");
    return;
  }
  messages_.back().signals.push_back(std::move(signal));
}

bool DbcParser::signal_head(DbcSignal& signal) {
  std::string_view name;
  if (!in_.word(name, "the signal's name")) return false;
  signal.name = name;
  if (in_.now().kind == DbcToken::Kind::kWord) {
    std::string_view mark = in_.now().text;
    signal.multiplexer = mark.ends_with('M');
    if (signal.multiplexer) mark.remove_suffix(1);
    signal.multiplexed = mark.starts_with('m');
    if (signal.multiplexed) {
      if (mark == "m" && !signal.multiplexer) {
        in_.add_slip(in_.now(), "a number after the multiplexer mark m");
        in_.advance();
        return in_.sign(':');
      }
      std::uint64_t value = 0;
      const auto [end, error] = std::from_chars(mark.data() + 1, mark.data() + mark.size(), value);
      if (error != std::errc() || end != mark.data() + mark.size()) {
        return in_.fail("M, m and a number, or m, a number and M");
      }
      signal.values = {{value, value}};
    } else if (!mark.empty()) {
      return in_.fail("M, m and a number, or ':'");
    }
    in_.advance();
  }
  return in_.sign(':');
}

bool DbcParser::signal_layout(DbcSignal& signal) {
  std::uint64_t start = 0, length = 0, order = 0;
  if (!in_.whole(start, 0xFFFF, "the start bit, 0 to 511") || !in_.sign('|') ||
      !in_.whole(length, 0xFFFF, "the length in bits, 1 to 64") || !in_.sign('@') ||
      !in_.whole(order, 1, "the byte order, 0 (Motorola) or 1 (Intel)")) {
    return false;
  }
  if (!in_.now().is_sign('+') && !in_.now().is_sign('-'))
    return in_.fail("+ (unsigned) or - (signed)");
  signal.type = in_.now().is_sign('-') ? SignalType::kSigned : SignalType::kUnsigned;
  in_.advance();
  signal.bits = {static_cast<std::uint16_t>(start), static_cast<std::uint16_t>(length),
                 order == 0 ? ByteOrder::kBig : ByteOrder::kLittle};
  return true;
}

bool DbcParser::signal_scale(DbcSignal& signal) {
  std::string_view unit;
  if (!in_.sign('(') || !in_.number(signal.factor, "the factor") || !in_.sign(',') ||
      !in_.number(signal.offset, "the offset") || !in_.sign(')') || !in_.sign('[')) {
    return false;
  }
  in_.limit(signal.least);
  if (!in_.sign('|')) return false;
  in_.limit(signal.most);
  if (!in_.sign(']') || !in_.text(unit, "the unit, a text in quotes")) return false;
  signal.unit = unit;
  return true;
}

void DbcParser::receivers() {
  while (((in_.now().kind == DbcToken::Kind::kWord || in_.now().kind == DbcToken::Kind::kNumber) &&
          !in_.at_statement()) ||
         in_.now().is_sign(',')) {
    in_.advance();
  }
}

// SIG_VALTYPE_ id signal : type ;
void DbcParser::value_type() {
  std::uint64_t id = 0, type = 0;
  std::string_view name;
  if (!message_and_signal(id, name)) return;
  if (in_.now().is_sign(':')) in_.advance();
  if (!in_.whole(type, 2, "0 (integer), 1 (float) or 2 (double)") || !in_.end_statement()) return;
  DbcSignal* const signal = signal_of(id, name);
  if (signal != nullptr && type != 0) {
    signal->type = type == 1 ? SignalType::kFloat : SignalType::kDouble;
  }
}

// SG_MUL_VAL_ id signal multiplexer 1-3, 5-5 ;
void DbcParser::multiplex_values() {
  std::uint64_t id = 0;
  std::string_view name, multiplexer;
  if (!message_and_signal(id, name) || !in_.word(multiplexer, "the multiplexing signal's name"))
    return;
  std::vector<CanSignal::Values> values;
  do {
    if (!values.empty()) in_.advance();
    CanSignal::Values range;
    if (!in_.whole(range.least, UINT64_MAX, "a range of values such as 1-3") || !in_.sign('-') ||
        !in_.whole(range.most, UINT64_MAX, "the end of a range of values")) {
      return;
    }
    values.push_back(range);
  } while (in_.now().is_sign(','));
  if (!in_.end_statement()) return;
  DbcSignal* const signal = signal_of(id, name);
  const DbcSignal* const by = signal_of(id, multiplexer);
  if (signal == nullptr || by == nullptr) return;
  signal->multiplexed = true;
  signal->selected_by = static_cast<std::int32_t>(by - message_with(id)->signals.data());
  signal->values = std::move(values);
}

// BA_ "name" [BU_ node | BO_ id | SG_ id signal | EV_ variable] value ;
void DbcParser::attribute() {
  std::string_view name;
  if (!in_.text(name, "an attribute's name in quotes")) return;
  if ((name == kLongSignal && in_.now().is("SG_")) ||
      (name == kLongMessage && in_.now().is("BO_"))) {
    long_name(name);
    return;
  }
  if (name != kCycleTime || !in_.now().is("BO_")) {
    in_.skip_statement();
    return;
  }
  in_.advance();
  std::uint64_t id = 0;
  if (!in_.whole(id, 0xFFFFFFFF, "the message's id")) return;
  double ms = 0;
  if (!in_.number(ms, "the cycle time in ms") || !in_.end_statement()) return;
  cycle_ms_[id] = ms;
}

// BA_ "SystemSignalLongSymbol" SG_ id signal "name" ;
void DbcParser::long_name(std::string_view attribute) {
  in_.advance();
  LongName found;
  std::string_view signal, name;
  if (!in_.whole(found.id, 0xFFFFFFFF, "the message's id")) return;
  if (attribute == kLongSignal && !in_.word(signal, "the signal's name")) return;
  if (!in_.text(name, "the long name in quotes")) return;
  found.signal = signal;
  found.name = name;
  if (!name.empty()) long_names_.push_back(std::move(found));
  in_.end_statement();
}

// Last: until here statements use the short names.
void DbcParser::apply_long_names() {
  for (const LongName& found : long_names_) {
    if (found.signal.empty()) {
      if (DbcMessage* const message = message_with(found.id)) message->long_name = found.name;
    } else if (DbcSignal* const signal = signal_of(found.id, found.signal)) {
      signal->long_name = found.name;
    }
  }
}

// BA_DEF_DEF_ "name" value ;
void DbcParser::attribute_default() {
  std::string_view name;
  if (!in_.text(name, "an attribute's name in quotes")) return;
  if (name != kCycleTime) {
    in_.skip_statement();
    return;
  }
  double ms = 0;
  if (in_.number(ms, "the cycle time in ms") && in_.end_statement()) default_cycle_ms_ = ms;
}

void DbcParser::apply_cycle_times() {
  constexpr double kMost_ms = 1e6;
  const auto seconds = [](double ms) {
    return ms > 0 && ms <= kMost_ms ? std::optional(ms / 1000) : std::nullopt;
  };
  for (DbcMessage& message : messages_) message.cycle_s = seconds(default_cycle_ms_);
  for (const auto& [id, ms] : cycle_ms_) {
    if (DbcMessage* const message = message_with(id)) message->cycle_s = seconds(ms);
  }
}

DbcMessage* DbcParser::message_with(std::uint64_t id) {
  const auto at = by_id_.find(id);
  return at == by_id_.end() ? nullptr : &messages_[at->second];
}

DbcSignal* DbcParser::signal_of(std::uint64_t id, std::string_view name) {
  DbcMessage* const message = message_with(id);
  if (message == nullptr) return nullptr;
  const auto at = std::find_if(message->signals.begin(), message->signals.end(),
                               [&](const DbcSignal& signal) { return signal.name == name; });
  return at == message->signals.end() ? nullptr : &*at;
}

bool DbcParser::message_and_signal(std::uint64_t& id, std::string_view& name) {
  return in_.whole(id, 0xFFFFFFFF, "the message's id") && in_.word(name, "the signal's name");
}

}  // namespace zonepack
