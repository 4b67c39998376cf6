"""C++ text without a compiler: comments and literals blanked, function heads found by their brackets.

Good for counts, not for refactoring: macros are not expanded, lambdas and local functions are not listed,
and the two branches of an #if are read one after the other.
"""

import re
from dataclasses import dataclass

_BLANKED = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)"'
    r'|"(?:\\.|[^"\\\n])*"'
    r"|(?<![0-9A-Za-z_])(?:u8|[uUL])?'(?:\\.|[^'\\\n])+'",
    re.S)
_DIRECTIVE = re.compile(r'^[ \t]*#(?:[^\n]*\\\n)*[^\n]*', re.M)
_KEYWORDS = {
    'alignas', 'bool', 'char', 'decltype', 'double', 'float', 'if', 'int', 'long', 'noexcept', 'requires',
    'return', 'sizeof', 'static_assert', 'unsigned', 'using', 'void', 'while'}


def without_comments(text):
    """The text with comments replaced by a blank; literals stay."""
    return _BLANKED.sub(lambda m: ' ' if m[0].startswith('/') else m[0], text)


def without_literals(text):
    """The text with comments, preprocessor lines and the inside of literals removed."""
    text = _BLANKED.sub(lambda m: ' ' if m[0].startswith('/') else '""' if m[0][-1] == '"' else "' '", text)
    return _DIRECTIVE.sub('', text)


@dataclass(frozen=True)
class Function:
    """One function head: its name without qualification and its parameters' texts."""
    name: str
    parameters: tuple

    @property
    def flags(self):
        """Number of parameters of type bool, by value."""
        return sum(1 for p in self.parameters if re.match(r'(?:const )?bool\b(?![ ]*[&*])', p))


def functions(text):
    """Every function head at namespace or class scope, declarations and definitions alike."""
    found = []
    for head in _heads(without_literals(text)):
        function = _function_of(head)
        if function:
            found.append(function)
    return found


def _heads(text):
    """The statements at namespace and class scope, each up to its ';' or '{'."""
    inside = []  # of each open brace: whether declarations stand there
    head, brackets = [], 0
    for character in text:
        declares = all(inside)
        if declares and character in '()':
            brackets += 1 if character == '(' else -1
        if brackets == 0 and character in '{};':
            words = ''.join(head)
            if character == '{':
                inside.append(declares and _declares(words))
            elif character == '}' and inside:
                inside.pop()
            if declares:
                # A comma first: what goes on after a member's initialiser in braces.
                if character != '}' and not words.lstrip().startswith(','):
                    yield words
                head = []
            elif all(inside):
                head = []
        elif declares:
            head.append(character)


def _declares(head):
    """Whether the brace after this head holds declarations: a namespace, a class, extern "C"."""
    if re.search(r'\bnamespace\b|\bextern ""\s*$', head):
        return True
    if re.search(r'\)\s*(?:const|noexcept)?\s*$', head):
        return False
    return bool(re.search(r'\b(?:class|struct|union)\b', head))


def _function_of(head):
    head = ' '.join(head.split())
    operator = re.search(r'\boperator ?(?:\(\)|[^\s\w(]+|[\w:]+(?: ?[&*])?) ?\(', head)
    opening = operator or re.search(r'([A-Za-z_]\w*) ?\(', head)
    if not opening:
        return None
    before = head[:opening.start()]
    name = 'operator' if operator else opening[1]
    if name in _KEYWORDS or '=' in re.sub(r'<[^<>]*>', '', before) or before.count('<') != before.count('>'):
        return None
    return Function(name, tuple(_parameters(head[opening.end():])))


def _parameters(text):
    """The parameters in a text that begins after their opening bracket, without default values."""
    parts, part, depth = [], [], 0
    for i, character in enumerate(text):
        if character == ')' and depth == 0:
            break
        if character == ',' and depth == 0:
            parts.append(''.join(part))
            part = []
            continue
        if character in '([{<':
            depth += 1
        elif character in ')]}' or (character == '>' and text[i - 1] != '-'):
            depth -= 1
        part.append(character)
    parts.append(''.join(part))
    parts = [p.split('=')[0].strip() for p in parts]
    return [] if parts in ([''], ['void']) else parts
