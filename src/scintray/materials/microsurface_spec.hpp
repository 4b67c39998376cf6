#pragma once
/// Specification of a microsurface, before anything is traced or built.

#include <optional>
#include <string>
#include <vector>

#include "scintray/core/error.hpp"
#include "scintray/core/shared.hpp"
#include "scintray/materials/relief_store.hpp"
#include "scintray/optics/medium.hpp"
#include "scintray/optics/surface.hpp"

namespace scintray::materials {

/// Media on the two sides of a surface, its stack, and the wavelengths in use (nm).
struct SurfaceSetting {
  const optics::SurfaceStack& stack;
  const optics::Medium &inside, &outside;
  double reference_nm, low_nm, high_nm;

  /// Indices on the two sides of the microsurface.
  optics::IndexPair indices(double wavelength_nm) const;
};

/// Definition of a microsurface, returned by a surface model's reader. Immutable.
class MicrosurfaceDefinition {
 public:
  virtual ~MicrosurfaceDefinition() = default;

  /// The microsurface between two media.
  /// @param reliefs  store of height fields and their tables, each made once
  /// @throws InputError for the content of the definition's files
  virtual optics::Microsurface make(const SurfaceSetting& setting, ReliefStore& reliefs) const = 0;

  /// Text of everything on which the microsurface depends besides the media: definitions of equal keys make
  /// the same. Nothing where that is not known; tables of stacks on such a microsurface are not cached.
  virtual std::optional<std::string> key() const { return std::nullopt; }

  /// Kind of the microsurface of make().
  virtual optics::MicrosurfaceKind kind() const { return optics::MicrosurfaceKind::rough; }

  /// The definition with rays traced on its height map; nothing when they are already, or without a height
  /// map.
  virtual std::optional<core::Shared<MicrosurfaceDefinition>> traced_on_the_spot() const {
    return std::nullopt;
  }

 protected:
  MicrosurfaceDefinition() = default;
  MicrosurfaceDefinition(const MicrosurfaceDefinition&) = default;
  MicrosurfaceDefinition(MicrosurfaceDefinition&&) = default;
  MicrosurfaceDefinition& operator=(const MicrosurfaceDefinition&) = default;
  MicrosurfaceDefinition& operator=(MicrosurfaceDefinition&&) = default;
};

/// A definition of any model, as a value.
using MicrosurfaceSpec = core::Shared<MicrosurfaceDefinition>;

/// A curve against wavelength (nm) of a microsurface, which must cover the wavelengths in use.
struct WavelengthTable {
  core::Curve curve;
  std::string what;  ///< "refractive indices", for messages
  core::FileLocation where;
};

/// A microsurface that is the same between any two media.
class FixedMicrosurface : public MicrosurfaceDefinition {
 public:
  /// @param key     as MicrosurfaceDefinition::key
  /// @param tables  curves of the microsurface; make() throws InputError where one does not cover the
  ///                wavelengths in use
  explicit FixedMicrosurface(optics::Microsurface microsurface, std::optional<std::string> key = std::nullopt,
                             std::vector<WavelengthTable> tables = {})
      : microsurface_(std::move(microsurface)), key_(std::move(key)), tables_(std::move(tables)) {}

  const optics::Microsurface& microsurface() const { return microsurface_; }
  optics::Microsurface make(const SurfaceSetting& setting, ReliefStore&) const override;
  std::optional<std::string> key() const override { return key_; }
  optics::MicrosurfaceKind kind() const override { return microsurface_->kind(); }

 private:
  optics::Microsurface microsurface_;
  std::optional<std::string> key_;
  std::vector<WavelengthTable> tables_;
};

}  // namespace scintray::materials
