#pragma once
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

namespace talus {

/// An allocator of a container whose elements are not set when `resize` adds them: plain data, which the user sets.
/// @tparam Allocator  allocates the memory
template <class Allocator>
struct NotSet : Allocator {
  using Allocator::Allocator;
  template <class Other>
  struct rebind {  // NOLINT(readability-identifier-naming): the standard's name
    using other = NotSet<typename std::allocator_traits<Allocator>::template rebind_alloc<Other>>;
  };
  template <class Element, class... Values>
  void construct(Element* element, Values&&... values) {
    static_assert(std::is_trivially_destructible_v<Element>);
    if constexpr (sizeof...(Values) > 0) ::new (static_cast<void*>(element)) Element{std::forward<Values>(values)...};
  }
};

}  // namespace talus
