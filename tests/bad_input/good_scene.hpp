#pragma once
/// A scene without mistakes, to put mistakes into.

namespace scintray::test {

inline constexpr const char* kGoodScene = R"(title = "Two parts"
ambient = "air"

[[part]]
name = "crystal"
box = ["2 mm", "2 mm", "20 mm"]
medium = "LSO"
surface = "lso_polished"
[[part.face]]
name = "exit"
select = { normal = [0, 0, -1] }
surface = "polished"

[[part]]
name = "pmt"
box = ["2 mm", "2 mm", "0.5 mm"]
place = { touch = "crystal", side = "-z", gap = "0.1 mm", fill = "grease" }
sensor = "R6231"

[[contact]]
between = ["pmt_fill", "pmt"]
kind = "bonded"

[source]
type = "photons"
region = { part = "crystal", slab_z = ["1 mm", "3 mm"] }
wavelength = "420 nm"
photons = 1000

[run]
seed = 7

[[tally]]
type = "exit_angle"
face = "crystal:exit"

[[sweep]]
key = "source.region.slab_z.center"
values = ["2 mm", "6 mm"]

[media.grease]
index = { value = 1.5 }
)";

}  // namespace scintray::test
