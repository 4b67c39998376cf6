#pragma once
/// A microsurface as its definition states it: nothing traced or built yet.

#include <optional>

#include "scintray/core/shared.hpp"
#include "scintray/materials/relief_store.hpp"
#include "scintray/optics/medium.hpp"
#include "scintray/optics/surface.hpp"

namespace scintray::materials {

/// What a surface lies between, and the wavelengths in use.
struct SurfaceSetting {
  const optics::SurfaceStack& stack;
  const optics::Medium &inside, &outside;
  double reference_nm, low_nm, high_nm;

  /// Indices on the two sides of the microsurface.
  optics::IndexPair indices(double wavelength_nm) const;
};

/// What a surface model's reader returns, and makes microsurfaces of. Immutable.
class MicrosurfaceDefinition {
 public:
  virtual ~MicrosurfaceDefinition() = default;

  /// The microsurface between two media.
  /// @param reliefs  makes height fields and their tables once, and keeps them
  /// @throws InputError for what the definition's files hold
  virtual optics::Microsurface make(const SurfaceSetting& setting, ReliefStore& reliefs) const = 0;

  /// As that of the microsurface that it makes.
  virtual optics::MicrosurfaceKind kind() const { return optics::MicrosurfaceKind::rough; }

  /// The same with rays followed on its height map; nothing when they are anyway, or it has none.
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

/// A microsurface that is the same between any two media.
class FixedMicrosurface : public MicrosurfaceDefinition {
 public:
  explicit FixedMicrosurface(optics::Microsurface microsurface) : microsurface_(std::move(microsurface)) {}

  const optics::Microsurface& microsurface() const { return microsurface_; }
  optics::Microsurface make(const SurfaceSetting&, ReliefStore&) const override { return microsurface_; }
  optics::MicrosurfaceKind kind() const override { return microsurface_->kind(); }

 private:
  optics::Microsurface microsurface_;
};

}  // namespace scintray::materials
