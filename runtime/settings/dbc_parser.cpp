// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/dbc_parser.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace zonepack {
namespace {

constexpr std::uint64_t kExtendedFlag = 0x80000000;
constexpr std::uint64_t kNoFrame = 0xC0000000;  // VECTOR__INDEPENDENT_SIG_MSG: signals of no frame
constexpr std::string_view kCycleTime = "GenMsgCycleTime";

// Words that begin a statement that ends with a semicolon and tells nothing about reading signals.
constexpr std::array<std::string_view, 24> kSkipped = {
    "VAL_TABLE_",  "VAL_",           "CM_",
    "EV_",         "ENVVAR_DATA_",   "EV_DATA_",
    "BA_DEF_",     "BA_DEF_SGTYPE_", "BA_SGTYPE_",
    "BO_TX_BU_",   "SIG_GROUP_",     "SGTYPE_",
    "SGTYPE_VAL_", "SIG_TYPE_REF_",  "SIGTYPE_VALTYPE_",
    "BA_DEF_REL_", "BA_REL_",        "BA_DEF_DEF_REL_",
    "BU_SG_REL_",  "BU_EV_REL_",     "BU_BO_REL_",
    "CAT_DEF_",    "CAT_",           "FILTER",
};
constexpr std::array<std::string_view, 10> kRead = {
    "VERSION", "NS_",          "BS_",         "BU_", "BO_",
    "SG_",     "SIG_VALTYPE_", "SG_MUL_VAL_", "BA_", "BA_DEF_DEF_",
};

template <std::size_t N>
bool holds(const std::array<std::string_view, N>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool is_statement_word(const DbcToken& token) {
  return token.kind == DbcToken::Kind::kWord &&
         (holds(kRead, token.text) || holds(kSkipped, token.text));
}

// What NS_ lists.
bool is_symbol(const DbcToken& token) {
  return token.kind == DbcToken::Kind::kWord &&
         (token.text == "NS_DESC_" || token.text == "SIG_VALTYPE_" || token.text == "SG_MUL_VAL_" ||
          token.text == "BA_" || token.text == "BA_DEF_DEF_" || holds(kSkipped, token.text));
}

std::string found(const DbcToken& token) {
  switch (token.kind) {
    case DbcToken::Kind::kEnd:
      return "the end of the file";
    case DbcToken::Kind::kText:
    case DbcToken::Kind::kOpenText:
      return "a text";
    default:
      return "'" + std::string(token.text.substr(0, 40)) + "'";
  }
}

}  // namespace

DbcParser::DbcParser(std::string_view text, std::string path)
    : path_(std::move(path)), lexer_(text), now_(lexer_.next()), ahead_(lexer_.next()) {
  while (now_.kind != Kind::kEnd && faults_.size() < LoadedDbc::kMostFaults) statement();
  apply_cycle_times();
}

void DbcParser::statement() {
  begin_ = now_;
  const auto is = [this](std::string_view word) { return begin_.is(word); };
  if (!is_statement_word(now_)) {
    fail("a statement such as BO_, SG_, CM_ or BA_");
    return;
  }
  advance();
  if (is("VERSION")) {
    std::string_view ignored;
    text(ignored, "the version, a text in quotes");
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
    skip_statement();
  }
}

// NS_ : CM_ BA_DEF_ ... has no end of its own, and what it lists begins statements elsewhere. A
// symbol stands alone on its line or before another one.
void DbcParser::symbols() {
  if (!sign(':')) return;
  while (now_.kind == Kind::kWord && !now_.is("BS_") && !now_.is("BU_") && !now_.is("BO_") &&
         (ahead_.first_on_line || ahead_.kind == Kind::kEnd ||
          (is_symbol(now_) && is_symbol(ahead_)))) {
    advance();
  }
}

// BS_: [rate : btr1 , btr2]
void DbcParser::bit_timing() {
  if (!sign(':')) return;
  while (now_.kind == Kind::kNumber || now_.is_sign(':') || now_.is_sign(',')) advance();
  if (now_.is_sign(';')) advance();
}

void DbcParser::nodes() {
  if (!sign(':')) return;
  while (now_.kind != Kind::kEnd && now_.kind != Kind::kText && !at_statement()) advance();
}

// BO_ id name: bytes sender
void DbcParser::message() {
  DbcMessage message;
  message.line = begin_.line;
  std::uint64_t id = 0;
  std::uint64_t bytes = 0;
  std::string_view name, sender;
  ignored_ = true;  // signals of a message that is not understood
  if (!whole(id, 0xFFFFFFFF, "the message's id, a whole number up to 4294967295") ||
      !word(name, "the message's name") || !sign(':') ||
      !whole(bytes, 0xFFFF, "the message's length in bytes") ||
      !word(sender, "the sender's name (Vector__XXX: none)")) {
    return;
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
  signal.line = begin_.line;
  signal.column = begin_.column;
  if (!signal_head(signal) || !signal_layout(signal) || !signal_scale(signal)) return;
  receivers();
  if (ignored_) return;
  if (messages_.empty()) {
    add_fault(begin_, "a message (BO_) before its signals");
    return;
  }
  if (++signals_ > kMostDbcSignals) {
    add_fault(begin_, "at most " + std::to_string(kMostDbcSignals) + " signals");
    return;
  }
  messages_.back().signals.push_back(std::move(signal));
}

bool DbcParser::signal_head(DbcSignal& signal) {
  std::string_view name;
  if (!word(name, "the signal's name")) return false;
  signal.name = name;
  if (now_.kind == Kind::kWord) {
    std::string_view mark = now_.text;
    signal.multiplexer = mark.ends_with('M');
    if (signal.multiplexer) mark.remove_suffix(1);
    signal.multiplexed = mark.starts_with('m');
    if (signal.multiplexed) {
      std::uint64_t value = 0;
      const auto [end, error] = std::from_chars(mark.data() + 1, mark.data() + mark.size(), value);
      if (error != std::errc() || end != mark.data() + mark.size()) {
        return fail("M, m and a number, or m, a number and M");
      }
      signal.values = {{value, value}};
    } else if (!mark.empty()) {
      return fail("M, m and a number, or ':'");
    }
    advance();
  }
  return sign(':');
}

bool DbcParser::signal_layout(DbcSignal& signal) {
  std::uint64_t start = 0, length = 0, order = 0;
  if (!whole(start, 0xFFFF, "the start bit, 0 to 511") || !sign('|') ||
      !whole(length, 0xFFFF, "the length in bits, 1 to 64") || !sign('@') ||
      !whole(order, 1, "the byte order, 0 (Motorola) or 1 (Intel)")) {
    return false;
  }
  if (!now_.is_sign('+') && !now_.is_sign('-')) return fail("+ (unsigned) or - (signed)");
  signal.type = now_.is_sign('-') ? SignalType::kSigned : SignalType::kUnsigned;
  advance();
  signal.bits = {static_cast<std::uint16_t>(start), static_cast<std::uint16_t>(length),
                 order == 0 ? ByteOrder::kBig : ByteOrder::kLittle};
  return true;
}

bool DbcParser::signal_scale(DbcSignal& signal) {
  std::string_view unit;
  if (!sign('(') || !number(signal.factor, "the factor") || !sign(',') ||
      !number(signal.offset, "the offset") || !sign(')') || !sign('[') ||
      !number(signal.least, "the least value") || !sign('|') ||
      !number(signal.most, "the largest value") || !sign(']') ||
      !text(unit, "the unit, a text in quotes")) {
    return false;
  }
  signal.unit = unit;
  return true;
}

void DbcParser::receivers() {
  while (((now_.kind == Kind::kWord || now_.kind == Kind::kNumber) && !at_statement()) ||
         now_.is_sign(',')) {
    advance();
  }
}

// SIG_VALTYPE_ id signal : type ;
void DbcParser::value_type() {
  std::uint64_t id = 0, type = 0;
  std::string_view name;
  if (!message_and_signal(id, name)) return;
  if (now_.is_sign(':')) advance();
  if (!whole(type, 2, "0 (integer), 1 (float) or 2 (double)") || !end_statement()) return;
  DbcSignal* const signal = signal_of(id, name);
  if (signal != nullptr && type != 0) {
    signal->type = type == 1 ? SignalType::kFloat : SignalType::kDouble;
  }
}

// SG_MUL_VAL_ id signal multiplexer 1-3, 5-5 ;
void DbcParser::multiplex_values() {
  std::uint64_t id = 0;
  std::string_view name, multiplexer;
  if (!message_and_signal(id, name) || !word(multiplexer, "the multiplexing signal's name")) return;
  std::vector<CanSignal::Values> values;
  do {
    if (!values.empty()) advance();
    CanSignal::Values range;
    if (!whole(range.least, UINT64_MAX, "a range of values such as 1-3") || !sign('-') ||
        !whole(range.most, UINT64_MAX, "the end of a range of values")) {
      return;
    }
    values.push_back(range);
  } while (now_.is_sign(','));
  if (!end_statement()) return;
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
  if (!text(name, "an attribute's name in quotes")) return;
  if (name != kCycleTime || !now_.is("BO_")) {
    skip_statement();
    return;
  }
  advance();
  std::uint64_t id = 0;
  if (!whole(id, 0xFFFFFFFF, "the message's id")) return;
  double ms = 0;
  if (!number(ms, "the cycle time in ms") || !end_statement()) return;
  cycle_ms_[id] = ms;
}

// BA_DEF_DEF_ "name" value ;
void DbcParser::attribute_default() {
  std::string_view name;
  if (!text(name, "an attribute's name in quotes")) return;
  if (name != kCycleTime) {
    skip_statement();
    return;
  }
  double ms = 0;
  if (number(ms, "the cycle time in ms") && end_statement()) default_cycle_ms_ = ms;
}

void DbcParser::skip_statement() {
  while (!now_.is_sign(';')) {
    if (now_.kind == Kind::kEnd || now_.kind == Kind::kOpenText ||
        (now_.column == 1 && is_statement_word(now_))) {
      fail("';' at the end of the " + std::string(begin_.text) + " of line " +
           std::to_string(begin_.line));
      return;
    }
    advance();
  }
  advance();
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

void DbcParser::advance() {
  if (now_.kind == Kind::kEnd) return;
  now_ = ahead_;
  ahead_ = lexer_.next();
}

bool DbcParser::at_statement() const { return now_.first_on_line && is_statement_word(now_); }

void DbcParser::add_fault(const DbcToken& at, const std::string& expected) {
  const bool open = at.kind == Kind::kOpenText;
  faults_.push_back(path_ + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) +
                    ": expected " +
                    (open ? "a quote at the end of the text that begins here" : expected) +
                    ", found " + (open ? "the end of the file" : found(at)));
}

bool DbcParser::fail(const std::string& expected) {
  add_fault(now_, expected);
  recover();
  return false;
}

void DbcParser::recover() {
  if (now_.line == begin_.line && now_.column == begin_.column) advance();
  while (now_.kind != Kind::kEnd && !at_statement()) advance();
}

bool DbcParser::sign(char wanted) {
  if (!now_.is_sign(wanted)) return fail(std::string("'") + wanted + "'");
  advance();
  return true;
}

bool DbcParser::word(std::string_view& into, const char* what) {
  if (now_.kind != Kind::kWord) return fail(what);
  into = now_.text;
  advance();
  return true;
}

bool DbcParser::number(double& into, const char* what) {
  const bool negative = now_.is_sign('-');
  if (negative || now_.is_sign('+')) advance();
  if (now_.kind != Kind::kNumber) return fail(what);
  into = negative ? -now_.number : now_.number;
  advance();
  return true;
}

bool DbcParser::whole(std::uint64_t& into, std::uint64_t most, const char* what) {
  if (now_.kind != Kind::kNumber) return fail(what);
  const char* const end = now_.text.data() + now_.text.size();
  const auto [stop, error] = std::from_chars(now_.text.data(), end, into);
  if (error != std::errc() || stop != end || into > most) return fail(what);
  advance();
  return true;
}

bool DbcParser::text(std::string_view& into, const char* what) {
  if (now_.kind != Kind::kText) return fail(what);
  into = now_.text;
  advance();
  return true;
}

bool DbcParser::end_statement() { return sign(';'); }

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
  return whole(id, 0xFFFFFFFF, "the message's id") && word(name, "the signal's name");
}

}  // namespace zonepack
