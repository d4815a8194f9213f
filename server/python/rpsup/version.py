# SPDX-License-Identifier: Apache-2.0
"""Version of the package: that of the program. CMake writes it into the copy that is packaged and tested."""

VERSION = "@RPSUP_VERSION@"
