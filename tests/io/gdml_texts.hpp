#pragma once
/// Small GDML files.

#include <string>

namespace scintray::test {

/// A file of these sections. The world is the box "world_box" of 1 m, of "Vacuum" (index 1).
struct GdmlText {
  std::string define, materials, solids, structure, daughters;

  std::string text() const {
    return R"(<?xml version="1.0"?>
<gdml>
<define>
<matrix name="ONE" coldim="2" values="2*eV 1 4*eV 1"/>
<matrix name="N15" coldim="2" values="2*eV 1.4 4*eV 1.6"/>
)" + define +
           R"(</define>
<materials>
<material name="Vacuum"><property name="RINDEX" ref="ONE"/><D value="1e-25"/></material>
<material name="Glass"><property name="RINDEX" ref="N15"/><D value="2.5"/></material>
<material name="Lead"><D value="11.35" unit="g/cm3"/></material>
)" + materials +
           R"(</materials>
<solids>
<box name="world_box" lunit="m" x="1" y="1" z="1"/>
)" + solids +
           R"(</solids>
<structure>
)" + structure +
           R"(<volume name="World"><materialref ref="Vacuum"/><solidref ref="world_box"/>
)" + daughters +
           R"(</volume>
</structure>
<setup name="Default" version="1.0"><world ref="World"/></setup>
</gdml>
)";
  }
};

inline std::string gdml_volume(const std::string& name, const std::string& solid,
                               const std::string& material = "Glass", const std::string& inside = "") {
  return "<volume name=\"" + name + "\"><materialref ref=\"" + material + "\"/><solidref ref=\"" + solid +
         "\"/>" + inside + "</volume>\n";
}

inline std::string gdml_placed(const std::string& name, const std::string& volume,
                               const std::string& placement = "") {
  return "<physvol name=\"" + name + "\"><volumeref ref=\"" + volume + "\"/>" + placement + "</physvol>\n";
}

/// One part of one solid.
inline GdmlText gdml_solid(const std::string& solid, const std::string& name = "it") {
  GdmlText text;
  text.solids = solid;
  text.structure = gdml_volume("body", name);
  text.daughters = gdml_placed("body_phys", "body");
  return text;
}

}  // namespace scintray::test
