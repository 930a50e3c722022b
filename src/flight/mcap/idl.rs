//! `ros2idl` schemas: the `.idl` files of a message and of the types it uses, in the part of OMG IDL that ROS 2
//! generates.

use super::idl_token::{Token, tokens};
use super::schema::{CdrSchema, Definition, Fields, Type};
use crate::flight::number::Number;
use std::collections::HashMap;

/// Sequences of sequences that a field may be.
const NESTING: usize = 8;

/// The layout of the message called `name`, such as `sensor_msgs/msg/Imu`.
pub fn schema(name: &str, text: &str) -> Result<CdrSchema, String> {
    let mut parser = Parser { tokens: tokens(text)?, at: 0, scope: Vec::new(), definitions: HashMap::new() };
    while parser.peek().is_some() {
        parser.definition().ok_or_else(|| parser.complaint())?;
    }
    CdrSchema::link(parser.definitions, &name.replace('/', "::"))
}

struct Parser<'a> {
    tokens: Vec<Token<'a>>,
    at: usize,
    scope: Vec<&'a str>,
    definitions: HashMap<String, Definition>,
}

impl<'a> Parser<'a> {
    fn complaint(&self) -> String {
        let around: Vec<_> = self.tokens[self.at.saturating_sub(4)..self.at].iter().map(|t| t.text()).collect();
        format!("its IDL schema cannot be read after {:?}", around.join(" "))
    }

    fn peek(&self) -> Option<Token<'a>> {
        self.tokens.get(self.at).copied()
    }

    fn next(&mut self) -> Option<Token<'a>> {
        let token = self.peek()?;
        self.at += 1;
        Some(token)
    }

    fn word(&mut self) -> Option<&'a str> {
        match self.next()? {
            Token::Word(word) => Some(word),
            Token::Mark(_) => None,
        }
    }

    /// Takes `mark` if it comes next.
    fn take(&mut self, mark: char) -> bool {
        let taken = self.peek() == Some(Token::Mark(mark));
        self.at += usize::from(taken);
        taken
    }

    fn expect(&mut self, mark: char) -> Option<()> {
        self.take(mark).then_some(())
    }

    fn define(&mut self, name: &str, definition: Definition) {
        let scope = self.scope.iter().map(|part| format!("{part}::")).collect::<String>();
        self.definitions.insert(scope + name, definition);
    }

    fn definition(&mut self) -> Option<()> {
        if self.take('}') {
            self.scope.pop()?;
            return self.expect(';');
        }
        self.annotations()?;
        match self.word()? {
            "module" => {
                let name = self.word()?;
                self.scope.push(name);
                self.expect('{')
            }
            "struct" => {
                let name = self.word()?;
                self.expect('{')?;
                let fields = self.fields()?;
                self.define(name, Definition::Struct(fields));
                self.expect(';')
            }
            "typedef" => {
                let of = self.of(0)?;
                for (name, of) in self.declared(&of)? {
                    self.define(&name, Definition::Alias(of));
                }
                Some(())
            }
            "enum" => {
                let name = self.word()?;
                self.define(name, Definition::Alias(Type::Number(Number::U32)));
                self.skip_past(';')
            }
            "const" => self.skip_past(';'),
            _ => None,
        }
    }

    fn skip_past(&mut self, mark: char) -> Option<()> {
        while self.next()? != Token::Mark(mark) {}
        Some(())
    }

    /// `@name` or `@name(...)`.
    fn annotations(&mut self) -> Option<()> {
        while self.take('@') {
            self.word()?;
            let mut open = usize::from(self.take('('));
            while open > 0 {
                match self.next()? {
                    Token::Mark('(') => open += 1,
                    Token::Mark(')') => open -= 1,
                    _ => {}
                }
            }
        }
        Some(())
    }

    fn fields(&mut self) -> Option<Fields> {
        let mut fields = Fields::new();
        while !self.take('}') {
            self.annotations()?;
            let of = self.of(0)?;
            fields.extend(self.declared(&of)?);
        }
        Some(fields)
    }

    /// What a declaration of type `of` declares, up to its semicolon: `a, b[3]`.
    fn declared(&mut self, of: &Type) -> Option<Fields> {
        let mut declared = Fields::new();
        loop {
            let name = self.word()?.to_string();
            let mut counts = Vec::new();
            while self.take('[') {
                counts.push(self.word()?.parse().ok()?);
                self.expect(']')?;
            }
            let list = |of, count| Type::List { of: Box::new(of), count: Some(count) };
            declared.push((name, counts.into_iter().rev().fold(of.clone(), list)));
            if !self.take(',') {
                self.expect(';')?;
                return Some(declared);
            }
        }
    }

    fn of(&mut self, nesting: usize) -> Option<Type> {
        let word = self.word()?;
        Some(Type::Number(match word {
            "boolean" => Number::Bool,
            "int8" => Number::I8,
            "uint8" | "octet" | "char" => Number::U8,
            "int16" | "short" => Number::I16,
            "uint16" => Number::U16,
            "int32" => Number::I32,
            "uint32" => Number::U32,
            "int64" => Number::I64,
            "uint64" => Number::U64,
            "float" => Number::F32,
            "double" => Number::F64,
            "unsigned" => self.integer(true)?,
            "long" => {
                self.at -= 1;
                self.integer(false)?
            }
            "string" => {
                self.bound()?;
                return Some(Type::Text);
            }
            "sequence" if nesting < NESTING => {
                self.expect('<')?;
                let of = Box::new(self.of(nesting + 1)?);
                if self.take(',') {
                    self.word()?;
                }
                self.expect('>')?;
                return Some(Type::List { of, count: None });
            }
            name => return Some(Type::Named(name.into())),
        }))
    }

    /// `short`, `long` or `long long`.
    fn integer(&mut self, unsigned: bool) -> Option<Number> {
        let mut long = 0;
        while self.peek() == Some(Token::Word("long")) {
            self.at += 1;
            long += 1;
        }
        Some(match (long, unsigned) {
            (0, _) if self.word()? == "short" => Number::U16,
            // `long double` is a number of 16 bytes.
            (1, false) if self.peek() != Some(Token::Word("double")) => Number::I32,
            (1, true) => Number::U32,
            (2, false) => Number::I64,
            (2, true) => Number::U64,
            _ => return None,
        })
    }

    /// The `<n>` of a bounded string.
    fn bound(&mut self) -> Option<()> {
        if self.take('<') {
            self.word()?;
            self.expect('>')?;
        }
        Some(())
    }
}
