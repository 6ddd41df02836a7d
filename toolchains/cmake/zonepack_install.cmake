# SPDX-License-Identifier: Apache-2.0
# install(): programs, libraries, headers and the package that find_package(zonepack) reads.
