# SPDX-License-Identifier: Apache-2.0
"""With what test/support has."""
import pathlib

__path__ += [str(pathlib.Path(__file__).resolve().parents[2] / "support")]
