// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/dbc_cursor.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "runtime/settings/dbc_file.hpp"

namespace zonepack {
namespace {

// Keywords of statements that end with a semicolon and do not affect reading signals.
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

// A symbol as NS_ lists them.
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

DbcCursor::DbcCursor(std::string_view text, std::string path)
    : path_(std::move(path)), lexer_(text), now_(lexer_.next()), ahead_(lexer_.next()) {}

bool DbcCursor::begin_statement() {
  begin_ = now_;
  if (!is_statement_word(now_)) return fail("a statement such as BO_, SG_, CM_ or BA_");
  advance();
  return true;
}

void DbcCursor::skip_statement() {
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

void DbcCursor::advance() {
  if (now_.kind == Kind::kEnd) return;
  now_ = ahead_;
  ahead_ = lexer_.next();
}

bool DbcCursor::at_symbol() const {
  return now_.kind == Kind::kWord && !now_.is("BS_") && !now_.is("BU_") && !now_.is("BO_") &&
         (ahead_.first_on_line || ahead_.kind == Kind::kEnd ||
          (is_symbol(now_) && is_symbol(ahead_)));
}

bool DbcCursor::at_statement() const { return now_.first_on_line && is_statement_word(now_); }

std::string DbcCursor::message(const DbcToken& at, const std::string& expected) const {
  const bool open = at.kind == Kind::kOpenText;
  return path_ + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": expected " +
         (open ? "a quote at the end of the text that begins here" : expected) + ", found " +
         (open ? "the end of the file" : found(at));
}

void DbcCursor::add_fault(const DbcToken& at, const std::string& expected) {
  if (found_.faults.size() < LoadedDbc::kMostFaults) {
    found_.faults.push_back(message(at, expected));
  }
}

void DbcCursor::add_slip(const DbcToken& at, const std::string& expected) {
  newest_ = message(at, expected);
  ++slip_count_;
  if (found_.slips.size() < LoadedDbc::kMostFaults) found_.slips.push_back(newest_);
}

void DbcCursor::condemn() {
  if (found_.faults.size() < LoadedDbc::kMostFaults) found_.faults.push_back(newest_);
  if (!found_.slips.empty() && found_.slips.back() == newest_) found_.slips.pop_back();
  --slip_count_;
}

DbcSlips DbcCursor::result() && {
  if (slip_count_ > found_.slips.size()) {
    found_.slips.push_back(path_ + ": " + std::to_string(slip_count_ - found_.slips.size()) +
                           " more of the same kind");
  }
  return std::move(found_);
}

bool DbcCursor::fail(const std::string& expected) {
  // What an open text swallows may be what is read.
  if (now_.kind == Kind::kOpenText) {
    add_fault(now_, expected);
  } else {
    add_slip(now_, expected);
  }
  recover();
  return false;
}

void DbcCursor::recover() {
  if (now_.line == begin_.line && now_.column == begin_.column) advance();
  while (now_.kind != Kind::kEnd && !at_statement()) advance();
}

bool DbcCursor::sign(char wanted) {
  if (!now_.is_sign(wanted)) return fail(std::string("'") + wanted + "'");
  advance();
  return true;
}

bool DbcCursor::word(std::string_view& into, const char* what) {
  if (now_.kind != Kind::kWord) return fail(what);
  into = now_.text;
  advance();
  return true;
}

bool DbcCursor::number(double& into, const char* what) {
  const bool negative = now_.is_sign('-');
  if (negative || now_.is_sign('+')) advance();
  if (now_.kind != Kind::kNumber) return fail(what);
  into = negative ? -now_.number : now_.number;
  advance();
  return true;
}

void DbcCursor::limit(double& into) {
  const bool negative = now_.is_sign('-');
  if (negative || now_.is_sign('+')) advance();
  const bool closed = ahead_.is_sign('|') || ahead_.is_sign(']');
  if (now_.kind == Kind::kNumber && closed) into = negative ? -now_.number : now_.number;
  while (now_.kind != Kind::kEnd && !now_.first_on_line && !now_.is_sign('|') &&
         !now_.is_sign(']')) {
    advance();
  }
}

bool DbcCursor::whole(std::uint64_t& into, std::uint64_t most, const char* what) {
  if (now_.kind != Kind::kNumber) return fail(what);
  const char* const end = now_.text.data() + now_.text.size();
  const auto [stop, error] = std::from_chars(now_.text.data(), end, into);
  if (error != std::errc() || stop != end || into > most) return fail(what);
  advance();
  return true;
}

bool DbcCursor::text(std::string_view& into, const char* what) {
  if (now_.kind != Kind::kText) return fail(what);
  into = now_.text;
  advance();
  return true;
}

}  // namespace zonepack
