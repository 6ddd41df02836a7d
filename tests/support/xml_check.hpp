// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cctype>
#include <string>
#include <string_view>
#include <vector>

namespace zonepack {

// A small strict XML reader: returns what is wrong with a document, or "". Knows elements, quoted
// attributes, the five named entities, and HTML's scripts, whose text is anything but the end tag;
// reports use nothing else.
class XmlCheck {
 public:
  static std::string problem_in(std::string_view text) { return XmlCheck(text).run(); }

 private:
  explicit XmlCheck(std::string_view text) : text_(text) {}

  std::string run() {
    for (std::string_view prolog :
         {"<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n", "<!DOCTYPE html>\n"}) {
      if (text_.starts_with(prolog)) text_.remove_prefix(prolog.size());
    }
    bool seen = false;
    while (at_ < text_.size()) {
      if (open_.empty() && seen && text_[at_] == '\n') {
        ++at_;
        continue;
      }
      if (open_.empty() && seen) return fault("more than one root");
      const std::string problem = text_[at_] == '<' ? tag() : character();
      if (!problem.empty()) return problem;
      seen = true;
    }
    return open_.empty() && seen ? "" : fault("not closed: " + (seen ? open_.back() : "nothing"));
  }

  std::string fault(const std::string& what) const {
    return what + " at byte " + std::to_string(at_) + ": " + std::string(text_.substr(at_, 40));
  }

  std::string character() {
    if (text_[at_] != '&') {
      ++at_;
      return "";
    }
    for (std::string_view entity : {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"}) {
      if (text_.substr(at_).starts_with(entity)) {
        at_ += entity.size();
        return "";
      }
    }
    return fault("bare ampersand");
  }

  std::string name() {
    const std::size_t from = at_;
    while (at_ < text_.size() && (std::isalnum(static_cast<unsigned char>(text_[at_])) ||
                                  text_[at_] == '-' || text_[at_] == ':')) {
      ++at_;
    }
    return std::string(text_.substr(from, at_ - from));
  }

  bool take(char c) {
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  std::string tag() {
    ++at_;
    const bool closing = take('/');
    const std::string element = name();
    if (element.empty()) return fault("no element name");
    if (closing) {
      if (!take('>')) return fault("end tag");
      if (open_.empty() || open_.back() != element) return fault("wrong end tag " + element);
      open_.pop_back();
      return "";
    }
    std::vector<std::string> attributes;
    while (take(' ')) {
      attributes.push_back(name());
      for (std::size_t i = 0; i + 1 < attributes.size(); ++i) {
        if (attributes[i] == attributes.back()) return fault("attribute twice: " + attributes[i]);
      }
      if (attributes.back().empty() || !take('=') || !take('"')) return fault("attribute");
      while (at_ < text_.size() && text_[at_] != '"') {
        if (text_[at_] == '<') return fault("< in attribute");
        if (const std::string problem = character(); !problem.empty()) return problem;
      }
      if (!take('"')) return fault("open quote");
    }
    if (take('/')) return take('>') ? "" : fault("empty element");
    if (!take('>')) return fault("start tag");
    open_.push_back(element);
    if (element == "script") {
      const std::size_t end = text_.find("</script", at_);
      if (end == std::string_view::npos) return fault("a script without its end");
      if (text_.substr(at_, end - at_).find("<!--") != std::string_view::npos) {
        return fault("a script that hides its end");
      }
      at_ = end;
    }
    return "";
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<std::string> open_;
};

// How often `part` stands in `text`.
inline std::size_t count_of(std::string_view text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos;
       at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

}  // namespace zonepack
