"""Sphinx configuration of the site; tools/docs copies it beside the pages."""

import os
import sys

project = 'ScintRay'
author = 'The ScintRay developers'
release = version = os.environ.get('SCINTRAY_VERSION', '')
extensions = ['myst_parser']
myst_heading_anchors = 4
source_suffix = {'.md': 'markdown'}
exclude_patterns = ['_build']
html_theme = 'furo'
html_title = f'ScintRay {version}'
html_static_path = ['_static']
html_extra_path = ['extra']
html_show_sphinx = False
highlight_language = 'none'
suppress_warnings = ['misc.highlighting_failure']
if os.environ.get('SCINTRAY_PYTHON'):
    sys.path.insert(0, os.environ['SCINTRAY_PYTHON'])
    extensions += ['sphinx.ext.autodoc', 'sphinx.ext.napoleon']
    autodoc_member_order = 'bysource'
    autodoc_typehints = 'description'
