#pragma once

#include <string>

namespace scintray::test {

/// Scene text: events of 100 keV in a crystal of 2 x 2 x 4 mm on a sensor, "pmt".
inline const std::string kSmallCrystal = R"(
title = "A small crystal"
ambient = "vacuum"
[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "4 mm"]
medium = "LSO"
surface = "polished"
[[part]]
name = "pmt"
box = ["2 mm", "2 mm", "1 mm"]
place = { touch = "crystal", side = "-z" }
sensor = "ideal"
[source]
type = "gamma_events"
events = 5
region = { part = "crystal" }
energy = "100 keV"
)";

}  // namespace scintray::test
