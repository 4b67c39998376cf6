#include "support/step_shapes.hpp"

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Controller.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <stdexcept>

namespace scintray::test {

namespace {

/// Open CASCADE's lengths are mm.
double millimetres(const std::string& unit) {
  static const std::map<std::string, double> known{{"MM", 1.0}, {"CM", 10.0}, {"M", 1000.0}, {"INCH", 25.4}};
  return known.at(unit);
}

TopoDS_Shape shape_of(const StepBody& body, double mm) {
  const double a = body.size[0] * mm, b = body.size[1] * mm, c = body.size[2] * mm;
  const gp_Pnt at(body.at[0] * mm, body.at[1] * mm, body.at[2] * mm);
  switch (body.solid) {
    case StepSolid::box:
      return BRepPrimAPI_MakeBox(at, a, b, c).Shape();
    case StepSolid::cylinder:
      return BRepPrimAPI_MakeCylinder(gp_Ax2(at, gp::DZ()), a, c).Shape();
    case StepSolid::sphere:
      return BRepPrimAPI_MakeSphere(at, a).Shape();
    case StepSolid::drilled_box:
      break;
  }
  const gp_Pnt middle(at.X() + a / 2, at.Y() + b / 2, at.Z() - c);
  const TopoDS_Shape drill = BRepPrimAPI_MakeCylinder(gp_Ax2(middle, gp::DZ()), b / 4, 3 * c).Shape();
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(at, a, b, c).Shape();
  TopExp_Explorer solid(BRepAlgoAPI_Cut(box, drill).Shape(), TopAbs_SOLID);
  return solid.Current();
}

Quantity_Color colour_of(const std::string& hex) {
  Quantity_Color colour;
  if (!Quantity_Color::ColorFromHex(hex.c_str(), colour)) throw std::invalid_argument(hex);
  return colour;
}

void set_name(const TDF_Label& label, const std::string& name) { TDataStd_Name::Set(label, name.c_str()); }

}  // namespace

void write_step(const std::filesystem::path& path, const std::vector<StepBody>& bodies,
                const std::string& unit) {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  const Handle(TDocStd_Document) document = new TDocStd_Document("BinXCAF");
  const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const Handle(XCAFDoc_ColorTool) colours = XCAFDoc_DocumentTool::ColorTool(document->Main());
  for (const StepBody& body : bodies) {
    const TopoDS_Shape shape = shape_of(body, millimetres(unit));
    const TDF_Label label = shapes->AddShape(shape, false);
    set_name(label, body.name);
    if (!body.colour.empty()) colours->SetColor(label, colour_of(body.colour), XCAFDoc_ColorSurf);
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(shape, TopAbs_FACE, faces);
    for (const auto& [number, name] : body.face_names)
      set_name(shapes->AddSubShape(label, faces.FindKey(number)), name);
    for (const auto& [number, hex] : body.face_colours)
      colours->SetColor(shapes->AddSubShape(label, faces.FindKey(number)), colour_of(hex), XCAFDoc_ColorSurf);
  }
  STEPCAFControl_Controller::Init();  // without it the settings are not there yet
  Interface_Static::SetCVal("write.step.unit", unit.c_str());
  Interface_Static::SetIVal("write.stepcaf.subshapes.name", 1);
  STEPCAFControl_Writer writer;
  if (!writer.Transfer(document) || writer.Write(path.c_str()) != IFSelect_RetDone)
    throw std::runtime_error("Open CASCADE could not write " + path.string());
}

}  // namespace scintray::test
