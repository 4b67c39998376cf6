#include "scintray/exchange/gdml/detail/copies.hpp"

#include <cmath>
#include <string_view>

#include "scintray/core/words.hpp"
#include "scintray/exchange/gdml/detail/divided_solids.hpp"
#include "scintray/exchange/gdml/detail/structure.hpp"

namespace scintray::exchange::gdml {

namespace {

constexpr core::Word<DivisionAxis> kAxes[] = {{"kXAxis", DivisionAxis::x},
                                              {"kYAxis", DivisionAxis::y},
                                              {"kZAxis", DivisionAxis::z},
                                              {"kRho", DivisionAxis::rho},
                                              {"kPhi", DivisionAxis::phi}};

constexpr std::string_view kDimensions = "_dimensions";

/// Attributes of dimensions of parameterised volumes that are called otherwise in the solid
/// (G4GDMLReadParamvol of Geant4 11.4).
constexpr core::Word<const char*> kRenamed[] = {
    {"InR", "rmin"},          {"OutR", "rmax"},         {"hz", "z"},
    {"StartPhi", "startphi"}, {"DeltaPhi", "deltaphi"}, {"startPhi", "startphi"},
    {"openPhi", "deltaphi"},  {"numSide", "numsides"}};

}  // namespace

Node CopyReader::child(Node node, const char* tag) const {
  const Node found = node.child(tag);
  if (!found)
    file_.reject(node, std::string("<") + node.name() + "> has no <" + tag + ">",
                 std::string("add <") + tag + " .../>");
  return found;
}

std::string CopyReader::solid_of(Node volume) const {
  const Node reference = child(volume, "solidref");
  return definitions_.name(file_.required(reference, "ref"), reference);
}

int CopyReader::count(Node element, double number) const {
  if (!(number >= 1.0 && number <= static_cast<double>(kMostPlaced)))
    file_.reject(element, std::string("<") + element.name() + "> has no number of copies from 1 on",
                 "give number=\"...\"");
  return static_cast<int>(number);
}

VolumeCopies CopyReader::replicas(Node replica, Node mother) const {
  const int number = count(replica, definitions_.number(replica, "number"));
  const Node along = child(replica, "replicate_along_axis"), direction = child(along, "direction");
  const Node width_node = child(along, "width"), offset_node = along.child("offset");
  const auto quantity = [&](Node node) {
    return definitions_.number(node, "value", 0.0) * definitions_.number(node, "unit", 1.0);
  };
  const core::Vec3 axis(definitions_.number(direction, "x", 0.0), definitions_.number(direction, "y", 0.0),
                        definitions_.number(direction, "z", 0.0));
  const bool about_z = definitions_.number(direction, "phi", 0.0) == 1.0;
  const bool rings = definitions_.number(direction, "rho", 0.0) == 1.0;
  const double axes = axis.norm() + (about_z ? 1.0 : 0.0) + (rings ? 1.0 : 0.0);
  if (axes != 1.0 || axis.lpNorm<1>() != axis.norm())
    file_.reject(replica, "replicas are along one of x, y, z, rho or phi", "give one of them the value 1");
  const double width = quantity(width_node), offset = offset_node ? quantity(offset_node) : 0.0;
  if (!(width > 0.0))
    file_.reject(replica, "the width of the replicas is not above 0",
                 "give <width value=\"...\" unit=\"mm\"/>, with unit deg for replicas about z");
  VolumeCopies result;
  if (rings) {
    const LoopedNode& tube = solids_.find(solid_of(mother), mother);
    if (std::string_view(tube.node.name()) != "tube")
      file_.reject(
          replica,
          std::string("replicas along rho are in a <tube>, and this is a <") + tube.node.name() + ">",
          "write the copies as <physvol>s");
    // The radii are those of the replicas, whatever the mother's inner radius.
    const DividedSolid divided(tube, definitions_, solids_);
    const LoopScope scope(definitions_, tube.variables);
    const double inner = definitions_.length(tube.node, "rmin");
    for (int copy = 0; copy < number; ++copy)
      result.copies.push_back(divided.copy(
          {DivisionAxis::rho, static_cast<double>(number), width, offset - inner}, copy, replica));
    return result;
  }
  for (int copy = 0; copy < number; ++copy) {
    if (about_z)
      result.copies.push_back(
          {Eigen::Affine3d(Eigen::AngleAxisd(offset + (copy + 0.5) * width, core::Vec3::UnitZ()))});
    else
      result.copies.push_back(
          {Eigen::Affine3d(Eigen::Translation3d(axis * (width * (copy - 0.5 * (number - 1)))))});
  }
  return result;
}

VolumeCopies CopyReader::divisions(Node division, Node mother) const {
  const std::optional<DivisionAxis> axis = core::find_word(kAxes, division.attribute("axis").value());
  if (!axis)
    file_.reject(division, "divisions are along kXAxis, kYAxis, kZAxis, kRho or kPhi", "give one as axis");
  const LoopedNode& solid = solids_.find(solid_of(mother), mother);
  const double unit = definitions_.number(division, "unit", 1.0);
  Division stated{*axis, definitions_.number(division, "number", 0.0),
                  unit * definitions_.number(division, "width", 0.0),
                  unit * definitions_.number(division, "offset", 0.0)};
  const DividedSolid divided(solid, definitions_, solids_);
  const double extent = divided.extent(*axis);
  if (!(extent > 0.0))
    file_.reject(division,
                 std::string("divisions other than along ") +
                     (divided.kind() == "box" || divided.kind() == "para" || divided.kind() == "trd"
                          ? "kXAxis, kYAxis or kZAxis of"
                      : divided.kind() == "tube" || divided.kind() == "cone" ? "kRho, kPhi or kZAxis of"
                      : divided.kind() == "polycone" || divided.kind() == "polyhedra"
                          ? "kRho or kPhi of"
                          : "those of box, para, trd, tube, cone, polycone and polyhedra, as of") +
                     " a <" + divided.kind() + "> are not read",
                 "write the copies as <physvol>s");
  constexpr double kRounding = 1e-9;
  if (stated.number == 0.0 && stated.width > 0.0)
    stated.number = std::floor((extent - stated.offset) / stated.width * (1.0 + kRounding));
  const int number = count(division, stated.number);
  if (stated.width == 0.0) stated.width = (extent - stated.offset) / number;
  if (!(stated.width > 0.0 && stated.offset + number * stated.width <= extent * (1.0 + 1e-6)))
    file_.reject(division,
                 "the copies of a division extend to " +
                     std::to_string(stated.offset + number * stated.width) + ", beyond the " +
                     std::to_string(extent) + " (mm or rad) of the solid that is divided",
                 "give a smaller number, width or offset");
  if (divided.kind() == "polyhedra" && *axis == DivisionAxis::phi) {
    const LoopScope scope(definitions_, solid.variables);
    if (definitions_.number(solid.node, "numsides") != number)
      file_.reject(division, "polyhedra are divided along kPhi by their sides", "give number=numsides");
  }
  VolumeCopies result;
  for (int copy = 0; copy < number; ++copy) result.copies.push_back(divided.copy(stated, copy, division));
  return result;
}

std::string CopyReader::solid_of_parameters(Node parameters, Node dimensions) const {
  std::string kind = dimensions.name();
  kind.resize(kind.size() - kDimensions.size());
  Node solid = solids_.new_element(kind, parameters);
  for (const pugi::xml_attribute attribute : dimensions.attributes()) {
    const std::optional<const char*> renamed = core::find_word(kRenamed, attribute.name());
    const char* own = renamed ? *renamed : attribute.name();
    solid.remove_attribute(own);
    solid.append_attribute(own) = attribute.value();
  }
  for (const Node plane : dimensions.children("zplane")) solid.append_copy(plane);
  return solids_.add(solid, parameters);
}

VolumeCopies CopyReader::parameterised(Node paramvol) const {
  const std::string volume_solid = file_.required(child(paramvol, "volumeref"), "ref");
  VolumeCopies result;
  const auto read = [&](Node parameters) {
    Node dimensions;
    for (const Node inner : parameters.children())
      if (std::string_view(inner.name()).ends_with(kDimensions)) dimensions = inner;
    VolumeCopy copy;
    copy.in_mother = Eigen::Translation3d(definitions_.position(parameters)) *
                     Eigen::Affine3d(rotation_matrix(definitions_.rotation(parameters)).transpose());
    if (dimensions) copy.solid = solid_of_parameters(parameters, dimensions);
    if (result.copies.size() >= kMostPlaced)
      file_.reject(parameters, "more than " + std::to_string(kMostPlaced) + " volumes are placed",
                   "import a part of the detector, or give fewer copies");
    result.copies.push_back(std::move(copy));
    const std::string_view kind = dimensions ? dimensions.name() : "";
    if (result.notes.empty() && (kind == "para_dimensions" || kind == "hype_dimensions"))
      result.notes.push_back("volume " + volume_solid + ": <" + std::string(kind) +
                             "> is taken as stated; Geant4 11.4 replaces its numbers by their units");
  };
  definitions_.for_each_child(paramvol, [&](Node content) {
    if (std::string_view(content.name()) != "parameterised_position_size") return;
    definitions_.for_each_child(content, [&](Node parameters) {
      if (std::string_view(parameters.name()) == "parameters") read(parameters);
    });
  });
  if (result.copies.empty())
    file_.reject(paramvol, "<paramvol> has no <parameters>",
                 "give <parameterised_position_size> with a <parameters> for each copy");
  return result;
}

}  // namespace scintray::exchange::gdml
