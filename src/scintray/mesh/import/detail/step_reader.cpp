#include "scintray/mesh/import/detail/step_isolation.hpp"

#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <Geom_Surface.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <Interface_InterfaceModel.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Poly_Triangulation.hxx>
#include <Precision.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <STEPConstruct_UnitContext.hxx>
#include <Standard_Failure.hxx>
#include <StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx.hxx>
#include <StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext.hxx>
#include <StepRepr_GlobalUnitAssignedContext.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_WorkSession.hxx>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <sstream>
#include <string_view>
#include <unordered_map>

#include "scintray/core/error.hpp"
#include "scintray/mesh/detail/surface_refinement.hpp"
#include "scintray/mesh/face_selection.hpp"
#include "scintray/mesh/import/file_checks.hpp"

namespace scintray::mesh {
namespace {

[[noreturn]] void reject_step(const std::filesystem::path& path, const std::string& reason) {
  reject_file(path, "cannot read the STEP file: " + reason,
              "expected ISO 10303-21 (AP203, AP214 or AP242); export it again");
}

std::string label_name(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  if (label.IsNull() || !label.FindAttribute(TDataStd_Name::GetID(), name)) return {};
  const TCollection_ExtendedString& text = name->Get();
  std::string bytes(static_cast<std::size_t>(text.LengthOfCString()), '\0');
  Standard_PCharacter start = bytes.data();
  text.ToUTF8CString(start);
  return bytes;
}

/// Names that CAD programs write for faces without one.
bool is_no_name(const std::string& name) { return name.empty() || name == "NONE"; }

core::Vec3 to_vec(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

/// The sphere, cylinder, cone or torus of a CAD face; nothing for any other surface.
std::optional<SupportSurface> support_of(const Handle(Geom_Surface) & surface, const gp_Trsf& transform) {
  if (surface.IsNull()) return std::nullopt;
  const GeomAdaptor_Surface adaptor(surface);
  switch (adaptor.GetType()) {
    case GeomAbs_Sphere: {
      const gp_Sphere sphere = adaptor.Sphere().Transformed(transform);
      return SupportSurface::sphere(to_vec(sphere.Location()), sphere.Radius());
    }
    case GeomAbs_Cylinder: {
      const gp_Cylinder cylinder = adaptor.Cylinder().Transformed(transform);
      return SupportSurface::cylinder(to_vec(cylinder.Location()),
                                      to_vec(gp_Pnt(cylinder.Axis().Direction().XYZ())), cylinder.Radius());
    }
    case GeomAbs_Cone: {
      const gp_Cone cone = adaptor.Cone().Transformed(transform);
      const double slope = std::tan(cone.SemiAngle());
      // The radius there is positive: one unit beyond the tip where that is the cone's own place.
      const double step = cone.RefRadius() > 0.0 ? 0.0 : std::copysign(1.0, slope);
      const double radius = cone.RefRadius() + step * slope;
      const core::Vec3 axis = to_vec(gp_Pnt(cone.Axis().Direction().XYZ()));
      return SupportSurface::cone(to_vec(cone.Location()) + step * axis, axis, radius, radius + slope, 1.0);
    }
    case GeomAbs_Torus: {
      const gp_Torus torus = adaptor.Torus().Transformed(transform);
      if (torus.MajorRadius() < torus.MinorRadius()) return std::nullopt;  // it crosses itself
      return SupportSurface::torus(to_vec(torus.Location()), to_vec(gp_Pnt(torus.Axis().Direction().XYZ())),
                                   torus.MajorRadius(), torus.MinorRadius());
    }
    default:
      return std::nullopt;
  }
}

class ShapeReader {
 public:
  ShapeReader(const Handle(TDocStd_Document) & document, const std::filesystem::path& path,
              const Tessellation& tessellation)
      : shapes_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
        colours_(XCAFDoc_DocumentTool::ColorTool(document->Main())),
        path_(path),
        tessellation_(tessellation) {}

  RawMesh read() {
    TDF_LabelSequence roots;
    shapes_->GetFreeShapes(roots);
    for (int i = 1; i <= roots.Length(); ++i) visit(roots.Value(i), TopLoc_Location(), 0);
    raw_.fill_body();
    if (loose_faces_ > 0)
      raw_.notes.push_back(std::to_string(loose_faces_) + " CAD faces left out: they belong to no solid");
    if (raw_.deviation_mm > tessellation_.deviation_mm)
      raw_.notes.push_back("coarser than requested, most of all: face" + std::to_string(coarsest_face_));
    if (uncut_faces_ > 0)
      reject_file(
          path_,
          std::to_string(uncut_faces_) + " of " + std::to_string(faces_) +
              " CAD faces could not be cut in triangles",
          "give the tessellation a larger deviation or angle, repair the shape in the CAD program, or "
          "export a mesh from it");
    return std::move(raw_);
  }

 private:
  /// Products may refer to each other; the standard allows no loops, but files may have them.
  void visit(const TDF_Label& label, const TopLoc_Location& placement, std::size_t depth) {
    if (depth > kDeepestNesting) reject_file(path_, "assemblies are nested more than 500 deep");
    TDF_Label product = label;
    TopLoc_Location place = placement;
    if (XCAFDoc_ShapeTool::IsReference(label)) {
      place = placement * XCAFDoc_ShapeTool::GetLocation(label);
      XCAFDoc_ShapeTool::GetReferredShape(label, product);
    }
    if (!XCAFDoc_ShapeTool::IsAssembly(product)) {
      read_product(product, place);
      return;
    }
    TDF_LabelSequence components;
    XCAFDoc_ShapeTool::GetComponents(product, components);
    for (int i = 1; i <= components.Length(); ++i) visit(components.Value(i), place, depth + 1);
  }

  void read_product(const TDF_Label& product, const TopLoc_Location& place) {
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(product);
    if (shape.IsNull()) return;
    cut(shape);
    const std::string name = label_name(product);
    bool solids = false;
    for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next()) {
      solids = true;
      read_body(product, solid.Current(), name, place);
    }
    if (!solids) {
      read_body(product, shape, name, place);
      return;
    }
    for (TopExp_Explorer face(shape, TopAbs_FACE, TopAbs_SOLID); face.More(); face.Next()) ++loose_faces_;
  }

  void cut(const TopoDS_Shape& shape) const {
    constexpr double kFinest = 1e-6;
    Bnd_Box box;
    BRepBndLib::Add(shape, box);
    const double size_mm = box.IsVoid() ? 0.0 : std::sqrt(box.SquareExtent());
    if (tessellation_.deviation_mm < kFinest * size_mm) {
      std::ostringstream text;
      text << "a tessellation within " << tessellation_.deviation_mm << " mm of a shape of " << size_mm
           << " mm is finer than a millionth of it";
      reject_file(path_, text.str(), "give the tessellation a larger deviation");
    }
    IMeshTools_Parameters settings;
    settings.Deflection = settings.DeflectionInterior = tessellation_.deviation_mm;
    settings.Angle = settings.AngleInterior = tessellation_.angle_rad;
    // A tenth of the deviation when it is not set, at which small circles are coarser than the angle.
    settings.MinSize = Precision::Confusion();
    BRepMesh_IncrementalMesh(shape, settings);
  }

  void read_body(const TDF_Label& product, const TopoDS_Shape& body, const std::string& name,
                 const TopLoc_Location& place) {
    raw_.begin_body(name);
    std::optional<std::string> colour = colour_of(product, body);
    if (!colour) colour = label_colour(product);
    for (TopExp_Explorer face(body, TopAbs_FACE); face.More(); face.Next())
      read_face(product, TopoDS::Face(face.Current()), colour, place);
  }

  std::optional<std::string> label_colour(const TDF_Label& label) const {
    Quantity_Color colour;
    for (const XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen}) {
      if (label.IsNull() || !colours_->GetColor(label, type, colour)) continue;
      std::string hex = Quantity_Color::ColorToHex(colour).ToCString();
      std::transform(hex.begin(), hex.end(), hex.begin(),
                     [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      return hex;
    }
    return std::nullopt;
  }

  std::optional<std::string> colour_of(const TDF_Label& product, const TopoDS_Shape& part) const {
    TDF_Label label;
    if (!shapes_->FindSubShape(product, part, label)) return std::nullopt;
    return label_colour(label);
  }

  void read_face(const TDF_Label& product, const TopoDS_Face& face,
                 const std::optional<std::string>& colour_of_body, const TopLoc_Location& place) {
    const std::string number = "face" + std::to_string(++faces_);
    TopLoc_Location own_place;
    const Handle(Poly_Triangulation) triangles = BRep_Tool::Triangulation(face, own_place);
    if (triangles.IsNull()) {
      ++uncut_faces_;
      return;
    }
    TDF_Label label;
    shapes_->FindSubShape(product, face, label);
    const std::string name = label_name(label);
    const std::optional<std::string> own_colour = label_colour(label);
    FaceTags tags{{"face", number}};
    if (own_colour || colour_of_body) tags["color"] = own_colour ? *own_colour : *colour_of_body;
    raw_.mesh.groups.push_back(!is_no_name(name) ? name : own_colour.value_or(number));
    raw_.mesh.group_tags.push_back(std::move(tags));

    const Handle(Geom_Surface) surface = BRep_Tool::Surface(face, own_place);
    // Instances of a product share the triangles of its faces.
    const auto known = patches_.find(triangles.get());
    const SurfacePatch& patch =
        known != patches_.end()
            ? known->second
            : patches_.emplace(triangles.get(), refined(surface, *triangles)).first->second;
    const gp_Trsf transform = (place * own_place).Transformation();
    const std::optional<SupportSurface> support = support_of(surface, transform);
    const std::uint32_t number_of_support = support ? raw_.mesh.support_index(*support) : kNoSupport;
    raw_.mesh.support.resize(raw_.mesh.triangles.size() + patch.triangles.size(), number_of_support);
    append(patch, transform, face.Orientation() == TopAbs_REVERSED);
  }

  void append(const SurfacePatch& patch, const gp_Trsf& transform, bool reversed) {
    TriMesh& mesh = raw_.mesh;
    if (mesh.vertices.size() + patch.vertices.size() > kMostElements ||
        mesh.triangles.size() + patch.triangles.size() > kMostElements)
      reject_file(path_, "the mesh has more than 2^31 vertices or triangles",
                  "give the tessellation a larger deviation");
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const core::Vec3& p : patch.vertices)
      mesh.vertices.push_back(to_vec(gp_Pnt(p.x(), p.y(), p.z()).Transformed(transform)));
    const bool turned = reversed != transform.IsNegative();
    for (std::array<std::uint32_t, 3> corner : patch.triangles) {
      if (turned) std::swap(corner[1], corner[2]);
      mesh.triangles.push_back({first + corner[0], first + corner[1], first + corner[2]});
      mesh.group.push_back(static_cast<std::uint32_t>(mesh.groups.size() - 1));
    }
  }

  /// The triangles of a face, refined where curved: Open CASCADE exceeds the deviation on free-form strips.
  SurfacePatch refined(const Handle(Geom_Surface) & surface, const Poly_Triangulation& triangles) {
    SurfacePatch patch;
    for (int i = 1; i <= triangles.NbNodes(); ++i) patch.vertices.push_back(to_vec(triangles.Node(i)));
    for (int i = 1; i <= triangles.NbTriangles(); ++i) {
      std::array<int, 3> node{};
      triangles.Triangle(i).Get(node[0], node[1], node[2]);
      const auto vertex = [](int n) { return static_cast<std::uint32_t>(n - 1); };
      patch.triangles.push_back({vertex(node[0]), vertex(node[1]), vertex(node[2])});
    }
    if (surface.IsNull() || !triangles.HasUVNodes() ||
        GeomAdaptor_Surface(surface).GetType() == GeomAbs_Plane)
      return patch;
    for (int i = 1; i <= triangles.NbNodes(); ++i)
      patch.parameters.emplace_back(triangles.UVNode(i).X(), triangles.UVNode(i).Y());
    const double reached_mm = refine(
        patch, [&](const Eigen::Vector2d& at) { return to_vec(surface->Value(at.x(), at.y())); },
        tessellation_.deviation_mm);
    if (reached_mm > raw_.deviation_mm) {
      raw_.deviation_mm = reached_mm;
      coarsest_face_ = faces_;
    }
    return patch;
  }

  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colours_;
  const std::filesystem::path& path_;
  Tessellation tessellation_;
  RawMesh raw_;
  std::size_t faces_ = 0, loose_faces_ = 0, uncut_faces_ = 0;
  std::unordered_map<const Poly_Triangulation*, SurfacePatch> patches_;
  std::size_t coarsest_face_ = 0;  ///< number of the face with the largest deviation
};

/// The unit of length of the first representation that has one.
FileUnit read_unit(STEPControl_Reader& reader) {
  TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
  reader.FileUnits(lengths, angles, solid_angles);
  const Handle(Interface_InterfaceModel) model = reader.Model();
  for (int i = 1; i <= model->NbEntities() && !lengths.IsEmpty(); ++i) {
    Handle(StepRepr_GlobalUnitAssignedContext) units =
        Handle(StepRepr_GlobalUnitAssignedContext)::DownCast(model->Value(i));
    if (const auto both = Handle(
            StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext)::DownCast(model->Value(i));
        !both.IsNull())
      units = both->GlobalUnitAssignedContext();
    if (const auto all = Handle(StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx)::DownCast(
            model->Value(i));
        !all.IsNull())
      units = all->GlobalUnitAssignedContext();
    STEPConstruct_UnitContext factors;
    if (units.IsNull() || factors.ComputeFactors(units) != 0 || !factors.LengthDone()) continue;
    return {lengths.Value(1).ToCString(), factors.LengthFactor(), true, 1.0};
  }
  return {"mm", 1.0, false, 1.0};
}

/// Entities with missing or wrong parts: Open CASCADE continues without them, and then follows null pointers.
void refuse_what_did_not_load(STEPCAFControl_Reader& reader, const std::filesystem::path& path) {
  const Interface_CheckIterator checks = reader.Reader().WS()->ModelCheckList(false);
  std::size_t failures = 0;
  std::string first;
  for (checks.Start(); checks.More(); checks.Next()) {
    const Handle(Interface_Check)& check = checks.Value();
    if (!check->HasFailed()) continue;
    if (failures++ == 0 && check->NbFails() > 0) first = check->CFail(1);
  }
  if (failures > 0)
    reject_file(path,
                std::to_string(failures) +
                    " entities of the STEP file are damaged; the first one: " + core::in_quotes(first),
                "export it again");
}

}  // namespace

RawMesh read_step(const std::filesystem::path& path, const std::string& content,
                  const Tessellation& tessellation) {
  try {
    Message::DefaultMessenger()->ChangePrinters().Clear();  // libraries must not print
    STEPCAFControl_Reader reader;
    // Names of single faces, as CAD programs write them.
    Interface_Static::SetIVal("read.stepcaf.subshapes.name", 1);
    std::istringstream stream(content);
    if (reader.ChangeReader().ReadStream(path.filename().c_str(), stream) != IFSelect_RetDone)
      reject_step(path, "it does not have the form of such a file");
    refuse_what_did_not_load(reader, path);
    Handle(TDocStd_Document) document = new TDocStd_Document("BinXCAF");
    FileUnit unit = read_unit(reader.ChangeReader());
    if (!reader.Transfer(document)) reject_step(path, "it holds no shape");
    RawMesh raw = ShapeReader(document, path, tessellation).read();
    raw.unit = std::move(unit);
    return raw;
  } catch (const Standard_Failure& failure) {
    reject_step(path, std::string("Open CASCADE reports ") + failure.DynamicType()->Name() + " " +
                          failure.GetMessageString());
  }
}

}  // namespace scintray::mesh
