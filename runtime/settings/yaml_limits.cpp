// SPDX-License-Identifier: Apache-2.0
#include "runtime/settings/yaml_limits.hpp"

#include <yaml-cpp/eventhandler.h>

#include <sstream>

namespace zonepack {
namespace {

struct TooMany {
  YAML::Mark mark;
};

class NodeCounter : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { count(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { count(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string&) override {
    count(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    count(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    count(mark);
  }
  void OnMapEnd() override {}

 private:
  void count(const YAML::Mark& mark) {
    if (++nodes_ > kMaxYamlNodes) throw TooMany{mark};
  }
  std::size_t nodes_ = 0;
};

}  // namespace

bool fits_yaml_limits(const std::string& text, FaultList& faults) {
  std::istringstream in(text);
  YAML::Parser parser(in);
  NodeCounter counter;
  try {
    while (parser.HandleNextDocument(counter)) {
    }
  } catch (const TooMany& found) {
    faults.add(found.mark, "",
               "here begins value " + std::to_string(kMaxYamlNodes + 1) + ", at most " +
                   std::to_string(kMaxYamlNodes) +
                   " keys and values are allowed; is this the right file?");
    return false;
  }
  return true;
}

}  // namespace zonepack
