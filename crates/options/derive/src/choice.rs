//! Enums without data.

use crate::attributes::{doc, type_name};
use proc_macro2::TokenStream;
use quote::quote;
use syn::{DataEnum, DeriveInput, Fields, Result};

pub fn expand(input: &DeriveInput, data: &DataEnum) -> Result<TokenStream> {
    let (ident, name) = (&input.ident, type_name(input)?);
    let type_doc = doc(&input.attrs);
    let mut described = vec![];
    let mut idents = vec![];
    for variant in &data.variants {
        if !matches!(variant.fields, Fields::Unit) {
            return Err(syn::Error::new_spanned(variant, "a choice holds no data"));
        }
        let (name, doc) = (in_kebab_case(&variant.ident.to_string()), doc(&variant.attrs));
        described.push(quote!((#name, ::boresight_options::doc(#doc))));
        idents.push(&variant.ident);
    }
    Ok(quote! {
        impl ::boresight_options::Described for #ident {
            const KIND: ::boresight_options::Kind = ::boresight_options::Kind::Choice(
                &::boresight_options::Choice {
                    name: #name,
                    doc: ::boresight_options::doc(#type_doc),
                    variants: &[#(#described),*],
                },
            );
        }

        impl ::boresight_options::Named for #ident {
            const VARIANTS: &'static [Self] = &[#(Self::#idents),*];

            fn place(self) -> usize {
                self as usize
            }
        }
    })
}

/// As serde's `rename_all = "kebab-case"` has it.
fn in_kebab_case(name: &str) -> String {
    let mut kebab = String::new();
    for (i, c) in name.char_indices() {
        if i > 0 && c.is_uppercase() {
            kebab.push('-');
        }
        kebab.extend(c.to_lowercase());
    }
    kebab
}
