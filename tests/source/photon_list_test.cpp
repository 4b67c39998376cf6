// Lists of photons of another program: files, columns, places, and what is refused.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "event_scene.hpp"
#include "scintray/core/h5.hpp"
#include "scintray/source/detail/photon_list_source.hpp"
#include "support/shared.hpp"
#include "support/zipped.hpp"

using namespace scintray;
using namespace scintray::core;
using namespace scintray::scene;
using namespace scintray::source;
using namespace scintray::test;

namespace {

std::filesystem::path list_file(const std::string& name, const std::string& content) {
  const std::filesystem::path file = scratch_folder("photon_list") / name;
  std::ofstream(file, std::ios::binary) << content;
  return file;
}

std::string list_source(const std::filesystem::path& file, const std::string& more = "") {
  return "type = \"photon_list\"\nfile = \"" + file.string() +
         "\"\nlength_unit = \"mm\"\nwavelength_unit = \"nm\"\n" + more;
}

constexpr const char* kListHead = "event,x,y,z,direction_x,direction_y,direction_z,wavelength\n";

PhotonListSource list_of(const std::string& source, const Scene& scene) {
  const scene_file::GammaSpec spec = gamma_spec(source);
  return {std::get<scene_file::PhotonListSpec>(spec.kind), spec.events, spec.unpolarised, scene};
}

Photon photon_of(const PhotonListSource& list, const Scene& scene, std::uint64_t event,
                 std::uint64_t number) {
  EventLight light;
  Rng rng(1, StreamKind::other, event, number);
  list.begin(scene, event, rng, light);
  return list.emit(scene, light, number, rng);
}

std::string list_refused(const std::string& csv, const std::string& more = "") {
  const Scene scene = lso_cube(10.0);
  return complaint([&] { list_of(list_source(list_file("bad.csv", csv), more), scene); });
}

/// A .npy file of version 1.
template <typename T>
std::string npy_of(const std::string& descr, const std::string& shape, const std::vector<T>& values,
                   bool fortran = false) {
  std::string header = "{'descr': " + descr + ", 'fortran_order': " + (fortran ? "True" : "False") +
                       ", 'shape': (" + shape + "), }";
  while ((10 + header.size() + 1) % 64 != 0) header += ' ';
  header += '\n';
  std::string bytes = "\x93NUMPY";
  bytes += std::string("\x01\x00", 2);
  bytes += static_cast<char>(header.size() % 256);
  bytes += static_cast<char>(header.size() / 256);
  bytes += header;
  const std::size_t at = bytes.size();
  bytes.resize(at + values.size() * sizeof(T));
  std::memcpy(bytes.data() + at, values.data(), values.size() * sizeof(T));
  return bytes;
}

}  // namespace

TEST_CASE("photons of a list become events in the order of their numbers, in our units") {
  const Scene scene = lso_cube(10.0);
  const auto csv =
      list_file("a.csv",
                "id,px,py,pz,mx,my,mz,e,t,ex,ey,ez\n"
                "7,0.1,0,0,0,0,2,2.5,3,1,0,0.5\n3,0,0.2,0,1,0,0,3,4,0,0,0\n7,0,0,0.3,0,1,0,2,5,0,0,1\n");
  const PhotonListSource list = list_of(
      "type = \"photon_list\"\nfile = \"" + csv.string() +
          "\"\nlength_unit = \"cm\"\nenergy_unit = \"eV\"\ntime_unit = \"us\"\npolarisation = \"listed\"\n"
          "columns = { event = \"id\", x = \"px\", y = \"py\", z = \"pz\", direction_x = \"mx\", direction_y "
          "= \"my\", "
          "direction_z = \"mz\", energy = \"e\", time = \"t\", polarisation_x = \"ex\", polarisation_y = "
          "\"ey\", "
          "polarisation_z = \"ez\" }",
      scene);
  REQUIRE(list.events() == 2);
  CHECK(list.photons() == 3);
  const Photon first = photon_of(list, scene, 1, 0);
  CHECK(first.position.vec().isApprox(Vec3(1, 0, 0)));
  CHECK(first.ray.direction.vec().isApprox(Vec3(0, 0, 1)));
  CHECK(first.ray.polarisation.vec().isApprox(Vec3(1, 0, 0)));  // the part across the direction
  CHECK(first.wavelength_nm == doctest::Approx(kHc_eV_nm / 2.5));
  CHECK(first.time_ns == doctest::Approx(3000.0));
  CHECK(scene.region_names[first.region] == "crystal");
  const Photon drawn = photon_of(list, scene, 0, 0);  // of zero polarisation
  CHECK(drawn.ray.polarisation.vec().norm() == doctest::Approx(1.0));
  CHECK(drawn.ray.polarisation.vec().dot(drawn.ray.direction.vec()) == doctest::Approx(0.0));
  REQUIRE(list.notes().size() == 1);
  CHECK(says(list.notes()[0], "1 of 3 photons"));
  CHECK(says(list.notes()[0], "a polarisation of zero"));
  CHECK(says(list.notes()[0], "row 3"));
}

TEST_CASE("photons without events are grouped, and events can be limited") {
  const Scene scene = lso_cube(10.0);
  std::string csv = "x,y,z,direction_x,direction_y,direction_z,wavelength\n";
  for (int i = 0; i < 7; ++i) csv += "0,0," + std::to_string(0.1 * i) + ",0,0,1,420\n";
  const auto file = list_file("grouped.csv", csv);
  const PhotonListSource list = list_of(list_source(file, "photons_per_event = 3\n"), scene);
  REQUIRE(list.events() == 3);
  CHECK(photon_of(list, scene, 2, 0).position.vec().isApprox(Vec3(0, 0, 0.6)));
  CHECK(list_of(list_source(file, "photons_per_event = 3\nevents = 2\n"), scene).photons() == 6);
  const PhotonListSource unpolarised =
      list_of(list_source(file, "photons_per_event = 3\npolarisation = \"unpolarised\"\n"), scene);
  CHECK(photon_of(unpolarised, scene, 0, 0).ray.polarisation.vec().isZero());
}

TEST_CASE("a photon on a face starts in the part into which it moves; elsewhere it is counted or refused") {
  const Scene scene = scene_of(
      box_part("crystal", "LSO", Vec3::Constant(10.0)) +
      box_part("shield", "opaque", Vec3(2.0, 2.0, 2.0), "translate = [\"20 mm\", \"0 mm\", \"0 mm\"]"));
  const auto csv =
      list_file("faces.csv", std::string(kListHead) +
                                 "0,0,0,5,0,0,1,420\n0,0,0,5,0,0,-1,420\n0,0,0,5.0000000001,0,0,-1,420\n"
                                 "0,0,0,8,0,0,1,420\n0,0,0,4,0,0,1,420\n");
  const PhotonListSource list = list_of(list_source(csv), scene);
  const auto region = [&](std::uint64_t number) {
    return scene.region_names[photon_of(list, scene, 0, number).region];
  };
  CHECK(photon_of(list, scene, 0, 0).region == kAmbientRegion);
  CHECK(region(1) == "crystal");
  CHECK(region(2) == "crystal");
  CHECK(photon_of(list, scene, 0, 3).region == kAmbientRegion);
  CHECK(region(4) == "crystal");
  for (const std::uint64_t number : {0, 1, 2})
    CHECK(std::abs(photon_of(list, scene, 0, number).position.vec().z() - 5.0) < 2e-6);
  CHECK(list.report().on_face.photons + list.report().ambient.photons >= 3);
  CHECK(says(list.notes().front(), "5 photons"));
  CHECK(list.regions().size() == 2);

  const auto inside =
      list_file("shield.csv", std::string(kListHead) + "0,20,0,0,0,0,1,420\n0,0,0,0,0,0,1,420\n");
  const std::string complains = complaint([&] { list_of(list_source(inside), scene); });
  CHECK(says(complains, "1 of 2 photons"));
  CHECK(says(complains, "row 2 (at 20, 0, 0 mm)"));
  const PhotonListSource left_out = list_of(list_source(inside, "misplaced = \"leave_out\"\n"), scene);
  CHECK(left_out.photons() == 1);
  CHECK(says(left_out.notes().front(), "1 of 2 photons"));
  const auto none = list_file("none.csv", std::string(kListHead) + "0,20,0,0,0,0,1,420\n");
  CHECK(says(complaint([&] { list_of(list_source(none, "misplaced = \"leave_out\"\n"), scene); }),
             "all 1 photons"));
}

TEST_CASE("lists of photons in HDF5 and NumPy files are those of CSV files") {
  const Scene scene = lso_cube(10.0);
  const auto same = [&](const PhotonListSource& list) {
    REQUIRE(list.events() == 2);
    const Photon photon = photon_of(list, scene, 1, 0);
    CHECK(photon.position.vec().isApprox(Vec3(1, 2, 3)));
    CHECK(photon.ray.direction.vec().isApprox(Vec3(0, -1, 0)));
    CHECK(photon.wavelength_nm == doctest::Approx(430.0));
  };
  const std::filesystem::path h5 = scratch_folder("photon_list_h5") / "list.lh5";
  h5::File file = h5::File::create(h5);
  h5::Group group = file.root().create_group("light");
  const std::vector<std::pair<const char*, std::vector<double>>> columns{
      {"event", {0, 1}},       {"x", {0, 1}},
      {"y", {0, 2}},           {"z", {0, 3}},
      {"direction_x", {0, 0}}, {"direction_y", {0, -1}},
      {"direction_z", {1, 0}}, {"wavelength", {420, 430}}};
  for (const auto& [name, values] : columns) group.write<double>(name, values);
  file.commit();
  same(list_of(list_source(h5, "group = \"light\"\n"), scene));

  // A structured array of mixed numbers, the last of them with its bytes in the other order.
  std::string rows;
  const auto put = [&](const auto& value) {
    rows.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  std::string descr = "[('event', '<i8'), ('', '|V2')";
  for (std::size_t k = 1; k < 7; ++k) descr += std::string(", ('") + columns[k].first + "', '<f4')";
  descr += ", ('wavelength', '>i2')]";
  for (std::size_t i = 0; i < 2; ++i) {
    put(static_cast<std::int64_t>(columns[0].second[i]));
    put(std::int16_t{77});
    for (std::size_t k = 1; k < 7; ++k) put(static_cast<float>(columns[k].second[i]));
    const auto nm = static_cast<std::uint16_t>(columns[7].second[i]);
    put(static_cast<std::uint16_t>(nm << 8 | nm >> 8));
  }
  same(list_of(list_source(list_file("structured.npy",
                                     npy_of(descr, "2,", std::vector<char>(rows.begin(), rows.end())))),
               scene));

  // Numbered columns: (2, 2, 4) as Opticks writes photons, and (2, 8) in Fortran's order.
  const std::string numbered =
      "photons_per_event = 1\ncolumns = { x = \"0\", y = \"1\", z = \"2\", direction_x = \"4\", direction_y "
      "= \"5\", "
      "direction_z = \"6\", wavelength = \"7\" }\n";
  same(list_of(list_source(list_file("opticks.npy",
                                     npy_of<float>("'<f4'", "2, 2, 4",
                                                   {0, 0, 0, 9, 0, 0, 1, 420, 1, 2, 3, 9, 0, -1, 0, 430})),
                           numbered),
               scene));
  same(list_of(
      list_source(list_file("fortran.npy",
                            npy_of<double>("'<f8'", "2, 8",
                                           {0, 1, 0, 2, 0, 3, 9, 9, 0, 0, 0, -1, 1, 0, 420, 430}, true)),
                  numbered),
      scene));

  std::vector<std::pair<std::string, std::string>> entries;
  for (const auto& [name, values] : columns)
    entries.emplace_back(std::string(name) + ".npy", npy_of<double>("'<f8'", "2,", values));
  same(list_of(list_source(list_file("list.npz", zipped(entries))), scene));
}

TEST_CASE("damaged NumPy files are refused") {
  const Scene scene = lso_cube(10.0);
  const auto says_of = [&](const std::string& content, const std::string& words,
                           const std::string& more = "") {
    return says(complaint([&] { list_of(list_source(list_file("bad.npy", content), more), scene); }), words);
  };
  CHECK(says_of("hello, this is text", "not an array of NumPy"));
  const std::string good = npy_of<double>("'<f8'", "3, 8", std::vector<double>(24, 0.0));
  CHECK(says_of(good.substr(0, good.size() - 8), "of which 184 are there"));
  CHECK(says_of(good.substr(0, 60), "does not end"));
  CHECK(says_of(npy_of<double>("'|O'", "1, 8", std::vector<double>(8)), "\"|O\""));
  CHECK(says_of(npy_of<double>("'<f8'", "99999999999, 99999999999, 99999", {0.0}), "impossible shape"));
  CHECK(says_of(npy_of<double>("[('x', '<f8', (3,))]", "1,", std::vector<double>(3)), "several numbers"));
  CHECK(says_of(good, "no column \"event\""));
  CHECK(says_of(npy_of<double>("[('x', '<f8')]", "1,", {0.0}), "\"event\""));
  for (std::size_t length = 0; length < good.size(); length += 7)
    CHECK_FALSE(complaint([&] {
                  list_of(list_source(list_file("cut.npy", good.substr(0, length))), scene);
                }).empty());
}

TEST_CASE("lists of photons that are wrong are refused with their rows") {
  const std::string head = kListHead;
  CHECK(says(list_refused(head + "0.5,0,0,0,0,0,1,420\n"), "bad.csv:2"));
  CHECK(says(list_refused(head + "0,0,0,0,0,0,0,420\n"), "direction is zero"));
  CHECK(says(list_refused(head + "0,0,0,0,0,0,1,0.42\n"), "10 to 100,000 nm"));
  CHECK(says(list_refused(head + "0,0,0,0,0,0,1,-5\n"), "-5"));
  CHECK(says(list_refused("event,x\n0,0\n"), "no column \"y\""));
  CHECK(says(
      list_refused("event,x,y,z,direction_x,direction_y,direction_z,wavelength,polarisation_x,polarisation_y,"
                   "polarisation_z\n0,0,0,0,0,0,1,420,0,0,1\n",
                   "polarisation = \"listed\"\n"),
      "along the direction"));
  const auto key = [](const std::string& more) {
    return complaint([&] { gamma_spec(list_source(list_file("key.csv", "x\n1\n"), more)); });
  };
  CHECK(says(key("columns = { time = \"t\" }"), "time_unit"));
  CHECK(says(key("columns = { polarisation_x = \"p\" }"), "listed"));
  CHECK(says(key("columns = { event = \"p\" }\nphotons_per_event = 5"), "photons_per_event"));
  CHECK(says(key("energy_unit = \"eV\""), "energy_unit"));
  CHECK(says(key("cherenkov = true"), "cherenkov"));
  CHECK(says(key("group = \"a\""), "groups"));
  CHECK(says(
      complaint([&] { gamma_spec("type = \"photon_list\"\nfile = \"a.root\"\nlength_unit = \"mm\"\n"); }),
      "a.root"));
}

TEST_CASE("photons in memory are those of a file, and wrong columns are refused") {
  const Scene scene = lso_cube(10.0);
  scene_file::GammaSpec spec = gamma_spec("type = \"photon_list\"\narrays = true");
  auto& list = std::get<scene_file::PhotonListSpec>(spec.kind);
  CHECK(says(complaint([&] { list.photons(); }), "did not set them"));
  scene_file::PhotonColumns columns;
  columns.event = {4, 2};
  columns.x_mm = columns.y_mm = columns.z_mm = {0, 1};
  columns.direction_x = columns.direction_y = {0, 0};
  columns.direction_z = {1, -1};
  columns.wavelength_nm = {420, 430};
  list.columns = std::make_shared<const scene_file::PhotonColumns>(columns);
  const PhotonListSource source(list, 0, false, scene);
  CHECK(source.events() == 2);
  CHECK(photon_of(source, scene, 0, 0).wavelength_nm == 430.0);
  columns.wavelength_nm.pop_back();
  scene_file::GammaSpec wrong = gamma_spec("type = \"photon_list\"\narrays = true");
  auto& short_list = std::get<scene_file::PhotonListSpec>(wrong.kind);
  short_list.columns = std::make_shared<const scene_file::PhotonColumns>(columns);
  CHECK(says(complaint([&] { short_list.photons(); }), "1 rows, and x has 2"));
}
