#pragma once
/// A reference to a callable.

#include <concepts>
#include <memory>
#include <type_traits>
#include <utility>

namespace scintray::core {

template <typename Signature>
class FunctionRef;

/// A function pointer with the address of the callable: two words, copied as bytes, without ownership. The
/// callable must outlive it. Empty by default, and then it must not be called.
template <typename Result, typename... Arguments>
class FunctionRef<Result(Arguments...)> {
 public:
  FunctionRef() = default;
  template <typename Callee>
  requires(!std::same_as<std::remove_cvref_t<Callee>, FunctionRef> &&
           std::is_invocable_r_v<Result, Callee&, Arguments...>)
      FunctionRef(
          Callee&& callee)  // NOLINT(google-explicit-constructor,bugprone-forwarding-reference-overload)
      : object_(const_cast<void*>(static_cast<const void*>(std::addressof(callee)))),
        call_([](void* object, Arguments... arguments) -> Result {
          return (*static_cast<std::remove_reference_t<Callee>*>(object))(
              std::forward<Arguments>(arguments)...);
        }) {}

  explicit operator bool() const { return call_ != nullptr; }
  Result operator()(Arguments... arguments) const {
    return call_(object_, std::forward<Arguments>(arguments)...);
  }

 private:
  void* object_ = nullptr;
  Result (*call_)(void*, Arguments...) = nullptr;
};

}  // namespace scintray::core
