// SPDX-License-Identifier: Apache-2.0
#pragma once

// Defines ZONEPACK_FOREIGN_HEAP where a sanitizer replaces glibc's heap: bounds on memory say
// nothing there, because sanitizers keep freed memory and shadows. ZONEPACK_FOREIGN_STACK where the
// thread sanitizer keeps most of a stack for itself.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define ZONEPACK_FOREIGN_HEAP
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define ZONEPACK_FOREIGN_HEAP
#endif
#endif

#if defined(__SANITIZE_THREAD__)
#define ZONEPACK_FOREIGN_STACK
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define ZONEPACK_FOREIGN_STACK
#endif
#endif
