#pragma once
/// Immutable objects of an open set of classes, held as values.

#include <concepts>
#include <memory>
#include <utility>

namespace scintray::core {

/// An immutable object of any class derived from Base, shared by its copies. Converts from such an object, or
/// from a shared pointer to one, which is not null; empty only after it was moved from.
template <typename Base>
class Shared {
 public:
  template <std::derived_from<Base> Object>
  Shared(Object object)  // NOLINT(google-explicit-constructor)
      : object_(std::make_shared<const Object>(std::move(object))) {}
  template <std::derived_from<Base> Object>
  Shared(std::shared_ptr<Object> object)  // NOLINT(google-explicit-constructor)
      : object_(std::move(object)) {}

  const Base& operator*() const { return *object_; }
  const Base* operator->() const { return object_.get(); }

  /// The object as one of a derived class; nullptr when it is of another.
  template <typename Object>
  const Object* get_if() const {
    return dynamic_cast<const Object*>(object_.get());
  }

 private:
  std::shared_ptr<const Base> object_;
};

}  // namespace scintray::core
