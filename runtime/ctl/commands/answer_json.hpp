// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "runtime/protocol/messages.hpp"

// Answers of zoned as JSON (runtime/README.md lists the keys), and notices as lines for people.
namespace zonepack {

// One object, without a line end.
std::string zone_json(const wire::Zone& zone);

// A document of one line. The answer's names and doors must fit together.
std::string route_json(const wire::Route& route);

// Of a notice: each event as a line of the event log. {"event":"events_lost","events":3} stands
// where some found no room; {"event":"map_in_use",...} before the first event of another map. Empty
// for a notice of another kind.
std::string notice_json(const wire::Reply& notice);

// The same for people: event_line() each.
std::string notice_text(const wire::Reply& notice);

}  // namespace zonepack
